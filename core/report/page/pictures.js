// The pictures in the page: PNGs of pixels, or of what they add to another picture of the same set, modulo 256.

const pictures = (() => {
  const kept = new Map();  // key -> Promise of ImageData, least recently used first
  const keptPixels = 6e7;
  let pixels = 0;

  async function decoded(packed) {
    const bytes = Uint8Array.from(atob(packed.png), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}), {colorSpaceConversion: 'none', premultiplyAlpha: 'none'});
    const canvas = el('canvas', {width: packed.width, height: packed.height});
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, packed.width, packed.height);
  }

  async function unpacked(shown, kind, index) {
    const packed = shownFrames[shown][kind][index];
    const [image, base] = await Promise.all([decoded(packed), packed.base < 0 ? null : get(shown, kind, packed.base)]);
    if (base === null) return image;
    const data = image.data;
    for (let i = 0; i < data.length; i += 4)
      for (let c = i; c < i + 3; ++c) data[c] = (data[c] + base.data[c]) & 255;
    return image;
  }

  function forgetOldest() {
    for (const [key, entry] of kept) {
      if (pixels <= keptPixels) return;
      kept.delete(key);
      pixels -= entry.pixels;
    }
  }

  /** Picture `index` of a set ('whole' or 'detail') as ImageData, or null if the page does not have it. */
  function get(shown, kind, index) {
    const packed = shownFrames[shown]?.[kind]?.[index];
    if (!packed) return Promise.resolve(null);
    const key = `${shown} ${kind} ${index}`;
    const entry = kept.get(key) ?? {pixels: packed.width * packed.height, image: unpacked(shown, kind, index)};
    if (!kept.delete(key)) pixels += entry.pixels;
    kept.set(key, entry);
    forgetOldest();
    return entry.image;
  }

  /** |a - b| times `gain`, as a picture. */
  function difference(a, b, gain) {
    const out = new ImageData(a.width, a.height);
    for (let i = 0; i < out.data.length; i += 4) {
      for (let c = i; c < i + 3; ++c) out.data[c] = Math.min(255, Math.abs(a.data[c] - b.data[c]) * gain);
      out.data[i + 3] = 255;
    }
    return out;
  }

  function canvasOf(image) {
    const canvas = el('canvas', {width: image.width, height: image.height});
    canvas.getContext('2d').putImageData(image, 0, 0);
    return canvas;
  }
  return {get, difference, canvasOf};
})();
