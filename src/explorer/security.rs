//! Who is answered: whoever knows the token, through an address of this machine.
//!
//! Other pages in the same browser can send requests here, too. They do not know the token, which is in the path; the `Host`
//! header shows a name that was bent to this machine (DNS rebinding), `Origin` and `Sec-Fetch-Site` show a page from elsewhere.

use super::http::Request;

/// Bytes of the token.
const TOKEN_BYTES: usize = 16;

/// What a request must show.
#[derive(Debug, Clone)]
pub(crate) struct Gate {
    token: String,
    hosts: [String; 2],
}

impl Gate {
    /// A gate with a new token, for a server at `port`.
    pub(crate) fn new(port: u16) -> anyhow::Result<Self> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes).map_err(|error| anyhow::anyhow!("the system gives no random numbers: {error}"))?;
        Ok(Self {
            token: bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
            hosts: ["127.0.0.1", "localhost"].map(|host| format!("{host}:{port}")),
        })
    }

    /// The page's address.
    pub(crate) fn address(&self) -> String {
        format!("http://{}/{}/", self.hosts[0], self.token)
    }

    /// The path below the token, if the request may be answered.
    pub(crate) fn admitted<'a>(&self, request: &'a Request) -> Option<&'a str> {
        let is_ours = |host: &str| self.hosts.iter().any(|own| own.eq_ignore_ascii_case(host));
        if !request.header("host").is_some_and(is_ours) {
            return None;
        }
        if let Some(origin) = request.header("origin")
            && !origin.strip_prefix("http://").is_some_and(is_ours)
        {
            return None;
        }
        if let Some(site) = request.header("sec-fetch-site")
            && !matches!(site, "same-origin" | "none")
        {
            return None;
        }
        let (token, rest) = request.path.strip_prefix('/')?.split_once('/')?;
        is_equal(token.as_bytes(), self.token.as_bytes()).then_some(rest)
    }
}

/// Takes as long for any wrong token of the right length.
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differs, (x, y)| differs | (x ^ y)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(path: &str, headers: &str) -> Request {
        Request::read(&mut format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes()).expect("a request")
    }

    #[test]
    fn only_the_own_page_is_answered() {
        let gate = Gate::new(7777).expect("random numbers");
        assert_eq!(gate.token.len(), 32);
        assert_ne!(gate.token, Gate::new(7777).expect("random numbers").token);
        let path = format!("/{}/api/state", gate.token);
        for good in [
            "Host: 127.0.0.1:7777\r\n",
            "Host: localhost:7777\r\nOrigin: http://localhost:7777\r\n",
            "Host: localhost:7777\r\nSec-Fetch-Site: none\r\n",
        ] {
            assert_eq!(gate.admitted(&request(&path, good)), Some("api/state"), "{good}");
        }
        for bad in [
            "",
            "Host: 127.0.0.1:7778\r\n",
            "Host: 127.0.0.1\r\n",
            "Host: evil.example:7777\r\n",
            "Host: 127.0.0.1:7777\r\nOrigin: http://evil.example\r\n",
            "Host: 127.0.0.1:7777\r\nOrigin: https://127.0.0.1:7777\r\n",
            "Host: 127.0.0.1:7777\r\nOrigin: null\r\n",
            "Host: 127.0.0.1:7777\r\nSec-Fetch-Site: cross-site\r\n",
            "Host: 127.0.0.1:7777\r\nSec-Fetch-Site: same-site\r\n",
        ] {
            assert_eq!(gate.admitted(&request(&path, bad)), None, "{bad}");
        }
        let host = "Host: 127.0.0.1:7777\r\n";
        for bad in [
            "/",
            "/api/state",
            "/0123456789abcdef0123456789abcdef/api/state",
            &path[..30],
        ] {
            assert_eq!(gate.admitted(&request(bad, host)), None, "{bad}");
        }
    }
}
