//! XML elements.

use std::collections::BTreeSet;

/// An element with its attributes and children.
#[derive(Debug, Clone)]
pub(in crate::export) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    pub(in crate::export) fn new(name: &'static str) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            children: Vec::new(),
        }
    }

    pub(in crate::export) fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.set(name, value);
        self
    }

    pub(in crate::export) fn set(&mut self, name: &'static str, value: impl Into<String>) {
        self.attributes.push((name, value.into()));
    }

    pub(in crate::export) fn push(&mut self, child: Element) {
        self.children.push(child);
    }

    pub(in crate::export) fn extend(&mut self, children: impl IntoIterator<Item = Element>) {
        self.children.extend(children);
    }

    /// The element on lines of its own, children further in.
    pub(in crate::export) fn write(&self, text: &mut String, depth: usize) {
        let margin = " ".repeat(depth);
        text.push_str(&margin);
        text.push('<');
        text.push_str(self.name);
        for (name, value) in &self.attributes {
            text.push(' ');
            text.push_str(name);
            text.push_str("=\"");
            escape(value, text);
            text.push('"');
        }
        if self.children.is_empty() {
            text.push_str("/>\n");
            return;
        }
        text.push_str(">\n");
        for child in &self.children {
            child.write(text, depth + 1);
        }
        text.push_str(&margin);
        text.push_str("</");
        text.push_str(self.name);
        text.push_str(">\n");
    }
}

fn escape(value: &str, text: &mut String) {
    for c in value.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            c => text.push(c),
        }
    }
}

/// Names that are in use.
#[derive(Debug, Default)]
pub(in crate::export) struct Ids(BTreeSet<String>);

impl Ids {
    /// A name that XML takes and that no one else has, as like the one wished for as can be.
    pub(in crate::export) fn take(&mut self, wish: &str) -> String {
        let mut name: String = wish
            .chars()
            .map(|c| {
                let is_fit = c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
                if is_fit { c } else { '_' }
            })
            .collect();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
            name.insert(0, '_');
        }
        let mut free = name.clone();
        let mut count = 2_usize;
        while !self.0.insert(free.clone()) {
            free = format!("{name}_{count}");
            count += 1;
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_xml_reads_is_what_was_meant() {
        let mut inner = Element::new("path");
        inner.set("id", "a\"<&>");
        let mut outer = Element::new("g");
        outer.push(inner);
        let mut text = String::new();
        outer.write(&mut text, 0);
        assert_eq!(text, "<g>\n <path id=\"a&quot;&lt;&amp;&gt;\"/>\n</g>\n");
    }

    #[test]
    fn names_are_fit_and_differ() {
        let mut ids = Ids::default();
        assert_eq!(ids.take("eye/left 1"), "eye_left_1");
        assert_eq!(ids.take("eye left/1"), "eye_left_1_2");
        assert_eq!(ids.take("7"), "_7");
        assert_eq!(ids.take(""), "_");
    }
}
