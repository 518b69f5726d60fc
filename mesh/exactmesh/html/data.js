// The arrays of the page: byte planes, deflated, in base64; decoded in small bites, so that the page stays alive.

const BITE = 1 << 20; // characters of base64 at a time, a multiple of 4
const BUDGET = 12; // milliseconds that work may take before the browser gets its turn

let turn = performance.now();

const late = () => performance.now() - turn > BUDGET;

async function breathe() {
  await new Promise((resolve) => setTimeout(resolve));
  turn = performance.now();
}

function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// Return the decoded bytes of a script element that holds base64, and empty it.
async function inflated(id, length) {
  const element = document.getElementById(id);
  const text = element.textContent.trim();
  element.textContent = "";
  const stream = new DecompressionStream("deflate");
  const writer = stream.writable.getWriter();
  const written = (async () => {
    for (let i = 0; i < text.length; i += BITE) {
      await writer.write(bytesOf(text.slice(i, i + BITE)));
      if (late()) await breathe();
    }
    await writer.close();
  })();
  const bytes = new Uint8Array(length);
  const reader = stream.readable.getReader();
  for (let at = 0; ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    bytes.set(value, at);
    at += value.length;
    if (late()) await breathe();
  }
  await written;
  return bytes;
}

// Return a typed array; the page has the first bytes of all numbers, then the second bytes, and so on.
async function unpacked(id, length, Type) {
  if (!length) return new Type(0);
  const size = Type.BYTES_PER_ELEMENT;
  const planes = await inflated(id, length * size);
  const bytes = new Uint8Array(length * size);
  for (let plane = 0; plane < size; plane++) {
    for (let begin = 0; begin < length; begin += BITE) {
      const end = Math.min(begin + BITE, length);
      const from = plane * length;
      for (let i = begin, at = begin * size + plane; i < end; i++, at += size) bytes[at] = planes[from + i];
      if (late()) await breathe();
    }
  }
  return new Type(bytes.buffer);
}
