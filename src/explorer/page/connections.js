// @ts-check
// Requests over connections that stay open (WebSockets). On a browser that is busy drawing, a fetch takes 3 to 5 ms longer, since it is
// set up anew each time; that is a third of the time between two displayed frames.
//
// A connection carries one request at a time. A request that finds none free goes by fetch, and one more is opened for the next.

/** @typedef {'GET' | 'POST'} Method */
/**
 * A text message of the socket: method and route, then the body as JSON, if there is one.
 * @typedef {`${Method} ${string}\n${string}`} Message
 */
/** @typedef {{ status: number, bytes: Uint8Array<ArrayBuffer>, text: () => string }} Answer A binary message of the socket, taken apart. */

/** Connections at a time: one waits for the next state, the others are for what moves at once. */
const MOST = 6;

/** Connections in a row that could not be opened, after which no more are tried: something between lets none through. */
const MOST_FAILURES = 3;

/** @type {WebSocket[]} */
const free = [];
let open = 0;
let failures = 0;

function connect() {
  open++;
  const address = new URL('api/socket', location.href);
  address.protocol = 'ws:';
  address.search = '';
  const connection = new WebSocket(address);
  connection.binaryType = 'arraybuffer';
  let isOpen = false;
  connection.addEventListener('open', () => {
    isOpen = true;
    failures = 0;
    free.push(connection);
  });
  connection.addEventListener('close', () => {
    open--;
    if (!isOpen) failures++;
    if (free.includes(connection)) free.splice(free.indexOf(connection), 1);
  });
}

/**
 * The answer to a request, `body` as JSON if there is one: {status, bytes, text()}; `bytes` begin at a multiple of four.
 * @type {(method: Method, route: string, body?: unknown) => Promise<Answer>}
 */
export async function exchange(method, route, body) {
  const connection = free.pop();
  if (connection) return overConnection(connection, method, route, body);
  if (open < MOST && failures < MOST_FAILURES) connect();
  /** @type {Record<string, string>} */
  const headers = body === undefined ? {} : { 'Content-Type': 'application/json' };
  const response = await fetch(`api/${route}`, { method, headers, body: body ? JSON.stringify(body) : undefined });
  return answered(response.status, new Uint8Array(await response.arrayBuffer()));
}

/** @type {(connection: WebSocket, method: Method, route: string, body: unknown) => Promise<Answer>} */
function overConnection(connection, method, route, body) {
  /** @type {Message} */
  const message = `${method} ${route}\n${body === undefined ? '' : JSON.stringify(body)}`;
  return new Promise((done, fail) => {
    const broken = () => fail(new TypeError('the connection to inbetween broke'));
    connection.addEventListener('close', broken);
    connection.addEventListener('message', ({ data }) => {
      connection.removeEventListener('close', broken);
      free.push(connection);
      const [status] = new Uint32Array(data, 0, 1);
      done(answered(status, new Uint8Array(data, 4)));
    }, { once: true });
    connection.send(message);
  });
}

const decoder = new TextDecoder();
/** @type {(status: number, bytes: Uint8Array<ArrayBuffer>) => Answer} */
const answered = (status, bytes) => ({ status, bytes, text: () => decoder.decode(bytes) });
