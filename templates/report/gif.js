// An animated GIF (GIF89a; W3C archive, "Graphics Interchange Format, version 89a", 1990). In: pictures of equal size, as
// RGBA pixels without transparency. Out: the bytes of a file that plays in a loop. Each picture after the first contains
// the smallest rectangle of changed pixels; the last entry of the palette leaves a pixel as it was.
const paletteSize = 256, unchanged = paletteSize - 1, longestGifCode = 12;

// Colours are told apart by 5 bits of each component.
const binOf = (pixels, at) => pixels[at] >> 3 << 10 | pixels[at + 1] >> 3 << 5 | pixels[at + 2] >> 3;

// The most frequent colours of some pictures, each the mean of its bin.
function paletteOf(pictures) {
  const bins = new Map();
  for (const pixels of pictures) {
    for (let at = 0; at < pixels.length; at += 4) {
      const bin = binOf(pixels, at), sums = bins.get(bin) || [0, 0, 0, 0];
      if (sums[0] === 0) bins.set(bin, sums);
      sums[0] += 1;
      for (let k = 0; k < 3; ++k) sums[k + 1] += pixels[at + k];
    }
  }
  return [...bins.values()].sort((a, b) => b[0] - a[0]).slice(0, unchanged).map(([count, ...sums]) => sums.map((sum) => Math.round(sum / count)));
}

// Variable-length codes of LZW, from the least significant bit on, in blocks of at most 255 bytes.
function compressed(indices) {
  const bytes = [], least = 8, clear = 1 << least, end = clear + 1;
  let bits = 0, count = 0, size = least + 1, next = end + 1, codes = new Map(), prefix = -1;
  const put = (code) => {
    bits |= code << count;
    for (count += size; count >= 8; count -= 8) {
      bytes.push(bits & 255);
      bits >>>= 8;
    }
  };
  put(clear);
  for (const index of indices) {
    if (prefix < 0) {
      prefix = index;
      continue;
    }
    const key = prefix << 8 | index, known = codes.get(key);
    if (known !== undefined) {
      prefix = known;
      continue;
    }
    put(prefix);
    if (next < 1 << longestGifCode) {
      codes.set(key, next);
      if (next++ === 1 << size) ++size;
    } else {
      put(clear);
      [codes, size, next] = [new Map(), least + 1, end + 1];
    }
    prefix = index;
  }
  put(prefix);
  put(end);
  if (count > 0) bytes.push(bits & 255);
  const blocks = [least];
  for (let at = 0; at < bytes.length; at += 255) blocks.push(Math.min(255, bytes.length - at), ...bytes.slice(at, at + 255));
  return [...blocks, 0];
}

class AnimatedGif {
  // delay: of each picture, in hundredths of a second; times: how often it plays, 0 for ever
  constructor(width, height, palette, delay, times = 0) {
    Object.assign(this, {width, height, palette, delay, before: null, nearest: new Int16Array(1 << 15).fill(-1), parts: []});
    const table = new Uint8Array(3 * paletteSize);
    palette.forEach((colour, i) => table.set(colour, 3 * i));
    this.parts.push([...Array.from("GIF89a", (c) => c.charCodeAt(0)), ...this.words(width, height), 0xf7, 0, 0], table,
      [0x21, 0xff, 11, ...Array.from("NETSCAPE2.0", (c) => c.charCodeAt(0)), 3, 1, ...this.words(times), 0]);
  }
  words(...numbers) { return numbers.flatMap((n) => [n & 255, n >> 8]); }

  colourAt(pixels, at) {
    const bin = binOf(pixels, at);
    if (this.nearest[bin] < 0) {
      const off = ([r, g, b]) => (r - pixels[at]) ** 2 + (g - pixels[at + 1]) ** 2 + (b - pixels[at + 2]) ** 2;
      this.nearest[bin] = this.palette.reduce((best, colour, i) => (off(colour) < off(this.palette[best]) ? i : best), 0);
    }
    return this.nearest[bin];
  }

  add(pixels) {
    const {width, height, before} = this, now = new Uint8Array(width * height);
    for (let i = 0; i < now.length; ++i) now[i] = this.colourAt(pixels, 4 * i);
    let [left, top, right, bottom] = before === null ? [0, 0, width - 1, height - 1] : [width, height, -1, -1];
    if (before !== null) {
      for (let i = 0; i < now.length; ++i) {
        if (now[i] === before[i]) continue;
        const x = i % width, y = (i - x) / width;
        [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
      }
      if (right < 0) [left, top, right, bottom] = [0, 0, 0, 0];
    }
    const indices = new Uint8Array((right - left + 1) * (bottom - top + 1));
    for (let y = top, k = 0; y <= bottom; ++y) for (let x = left; x <= right; ++x, ++k) indices[k] = before !== null && now[y * width + x] === before[y * width + x] ? unchanged : now[y * width + x];
    this.parts.push([0x21, 0xf9, 4, before === null ? 4 : 5, ...this.words(this.delay), unchanged, 0, 0x2c, ...this.words(left, top, right - left + 1, bottom - top + 1), 0], compressed(indices));
    this.before = now;
  }

  bytes() {
    const parts = [...this.parts, [0x3b]], all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of parts) {
      all.set(part, at);
      at += part.length;
    }
    return all;
  }
}
