// PNG pictures of 8 bits a channel, without a library, and how far two are apart.
import { crc32, deflateSync, inflateSync } from 'node:zlib';

/** {width, height, channels, pixels} of a PNG file without interlacing. */
export function decodePng(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const parts = [];
  let header = null;
  for (let at = 8; at < bytes.length;) {
    const length = view.getUint32(at);
    const kind = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (kind === 'IHDR') header = { width: view.getUint32(at + 8), height: view.getUint32(at + 12), depth: bytes[at + 16], colour: bytes[at + 17], interlaced: bytes[at + 20] };
    if (kind === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + length));
    at += 12 + length;
  }
  const channels = { 0: 1, 2: 3, 4: 2, 6: 4 }[header.colour];
  if (header.depth !== 8 || header.interlaced || !channels) throw new Error('a PNG file of a kind that is not read here');
  const raw = inflateSync(Buffer.concat(parts));
  const { width, height } = header;
  const stride = width * channels;
  const pixels = new Uint8Array(stride * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; x++) {
      const value = raw[y * (stride + 1) + 1 + x];
      const left = x >= channels ? pixels[y * stride + x - channels] : 0;
      const up = y > 0 ? pixels[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y > 0 ? pixels[(y - 1) * stride + x - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      pixels[y * stride + x] = value + guess;
    }
  }
  return { width, height, channels, pixels };
}

/** A PNG file of red, green, blue, alpha at every pixel, as `colour(x, y)` has them. */
export function encodePng(width, height, colour) {
  const rows = Buffer.alloc((4 * width + 1) * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) rows.set(colour(x, y), (4 * width + 1) * y + 1 + 4 * x);
  }
  const chunk = (kind, data) => {
    const body = Buffer.concat([Buffer.from(kind), data]);
    const ends = [Buffer.alloc(4), Buffer.alloc(4)];
    ends[0].writeUInt32BE(data.length);
    ends[1].writeUInt32BE(crc32(body));
    return Buffer.concat([ends[0], body, ends[1]]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width);
  header.writeUInt32BE(height, 4);
  header.set([8, 6], 8);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([signature, chunk('IHDR', header), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

function paeth(left, up, corner) {
  const guess = left + up - corner;
  const [a, b, c] = [Math.abs(guess - left), Math.abs(guess - up), Math.abs(guess - corner)];
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/** How far the colours of `part` are from those of `whole`, of which it is the part that begins at `corner`. */
export function difference(part, whole, [left, top] = [0, 0]) {
  let sum = 0;
  let far = 0;
  let most = 0;
  const [width, height] = [Math.min(part.width, whole.width - left), Math.min(part.height, whole.height - top)];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      let apart = 0;
      for (let c = 0; c < 3; c++) {
        const a = part.pixels[(y * part.width + x) * part.channels + c];
        const b = whole.pixels[((y + top) * whole.width + x + left) * whole.channels + c];
        apart = Math.max(apart, Math.abs(a - b));
      }
      sum += apart;
      far += apart > 40;
      most = Math.max(most, apart);
    }
  }
  const count = width * height;
  return { mean: sum / count, far, most, count };
}
