// What the program wrote into the page. Arrays are 32-bit integers: differences to the element `stride` before, taken
// `order` times, zigzag-coded, the lowest bytes of all first, deflated.

function unpack(bytes, {at, count, stride, order}) {
  const out = new Int32Array(count);
  for (let i = 0; i < count; ++i) {
    const z = bytes[at + i] | bytes[at + count + i] << 8 | bytes[at + 2 * count + i] << 16 | bytes[at + 3 * count + i] << 24;
    out[i] = z >>> 1 ^ -(z & 1);
  }
  for (let k = 0; k < order; ++k) for (let i = stride; i < count; ++i) out[i] += out[i - stride];
  return out;
}

// inflate: what is deflated in the element of an id, as a response (page.html)
export async function readFilm(inflate) {
  const film = JSON.parse(document.getElementById('film').textContent);
  const bytes = new Uint8Array(await inflate('data').arrayBuffer());
  film.arrays = {};
  for (const [name, where] of Object.entries(film.sections)) film.arrays[name] = unpack(bytes, where);
  return film;
}
