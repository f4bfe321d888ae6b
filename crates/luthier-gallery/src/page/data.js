// What the page brings along: JSON whose long strings are deflated bytes in base64.
const data = JSON.parse(document.getElementById("page-data").textContent);

async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const inflateText = async text => new TextDecoder().decode(await inflate(text));

/** Bytes of elements of a size, whose first bytes come first of all, then their second bytes. */
async function inflateBytes(text, element) {
  const planes = await inflate(text);
  const count = planes.length / element;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < element; plane++) {
    for (let i = 0; i < count; i++) bytes[i * element + plane] = planes[plane * count + i];
  }
  return bytes.buffer;
}

/** Images of the given sizes: RGBA of half floats. Stored are differences along each channel, high bytes before low ones. */
async function inflateImages(text, sizes) {
  const planes = await inflate(text);
  const low = planes.length / 2;
  let at = 0;
  return sizes.map(([width, height]) => {
    const texels = new Uint16Array(4 * width * height);
    for (let channel = 0; channel < 3; channel++) {
      let value = 0;
      for (let i = 0; i < width * height; i++, at++) {
        value = (value + 256 * planes[at] + planes[low + at]) & 0xffff;
        texels[4 * i + channel] = value;
      }
    }
    for (let i = 3; i < texels.length; i += 4) texels[i] = 0x3c00;
    return { width, height, texels };
  });
}

/** A function that computes its value once, and gives the same promise from then on. */
function kept(compute) {
  const values = new Map();
  return key => {
    if (!values.has(key)) values.set(key, compute(key));
    return values.get(key);
  };
}
