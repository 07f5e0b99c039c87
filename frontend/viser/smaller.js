/**
 * Cloth from afar without beats. WebGL makes each smaller copy of a picture from means of four pixels of the one before;
 * where columns of stitches are hardly wider than pixels, those are rings and fans that no cloth has. Here six pixels
 * each way count, the farther the less.
 *
 * A plain script without imports: the service puts it into viser's page.
 */

(() => {
  /** Shares of six pixels along a line in a pixel of the next smaller picture. */
  const SHARES = [1, 5, 10, 10, 5, 1].map((share) => share / 32);
  const GAMMA = 2.2;
  const FINE = 4095;
  const LIGHT = Float32Array.from({ length: 256 }, (_, value) => (value / 255) ** GAMMA);
  const VALUE = Uint8Array.from({ length: FINE + 1 }, (_, light) => Math.round(255 * (light / FINE) ** (1 / GAMMA)));

  /** @typedef {{width: number, height: number, light: Float32Array}} Picture light of each pixel, red, green and blue
   * times its cover, and cover */

  /** @param {ImageData} image @returns {Picture} */
  function lit({ width, height, data }) {
    const light = new Float32Array(data.length);
    for (let at = 0; at < data.length; at += 4) {
      const cover = data[at + 3] / 255;
      for (let k = at; k < at + 3; k++) light[k] = cover * LIGHT[data[k]];
      light[at + 3] = cover;
    }
    return { width, height, light };
  }

  /** @param {Picture} picture */
  function bytes({ light }) {
    const data = new Uint8Array(light.length);
    for (let at = 0; at < data.length; at += 4) {
      const cover = light[at + 3];
      const share = FINE / Math.max(cover, 1e-6);
      for (let k = at; k < at + 3; k++) data[k] = VALUE[Math.min(FINE, Math.round(share * light[k]))];
      data[at + 3] = Math.round(255 * cover);
    }
    return data;
  }

  /**
   * Lines of half the length.
   *
   * @param {Float32Array} from
   * @param {number} length of a line, pixels
   * @param {number} step from a pixel of a line to the next, in numbers
   * @param {number} lines
   * @param {number} apart from a line to the next, in numbers
   * @param {[number, number]} to step and apart of what comes out
   */
  function halved(from, length, step, lines, apart, to) {
    const half = Math.max(1, length >> 1);
    const light = new Float32Array(4 * half * lines);
    for (let x = 0; x < half; x++) {
      const places = SHARES.map((_, k) => step * Math.min(length - 1, Math.max(0, 2 * x + k - 2)));
      for (let line = 0; line < lines; line++)
        for (let part = 0; part < 4; part++) {
          const start = line * apart + part;
          let sum = 0;
          for (let k = 0; k < 6; k++) sum += SHARES[k] * from[start + places[k]];
          light[x * to[0] + line * to[1] + part] = sum;
        }
    }
    return light;
  }

  /** @param {Picture} picture @returns {Picture} */
  function smaller({ width, height, light }) {
    const [half, low] = [Math.max(1, width >> 1), Math.max(1, height >> 1)];
    const across = halved(light, width, 4, height, 4 * width, [4, 4 * half]);
    return { width: half, height: low, light: halved(across, height, 4 * half, half, 4, [4 * half, 4]) };
  }

  const gl = /** @type {any} */ (WebGL2RenderingContext.prototype);
  /** What the texture got last. @type {HTMLImageElement | null} */
  let image = null;
  for (const name of ["texImage2D", "texSubImage2D"]) {
    const give = gl[name];
    gl[name] = function (/** @type {any[]} */ ...how) {
      const last = how.at(-1);
      image = last instanceof HTMLImageElement ? last : null;
      give.apply(this, how);
    };
  }
  const { generateMipmap } = gl;
  gl.generateMipmap = function (/** @type {number} */ target) {
    generateMipmap.call(this, target);
    if (!image) return;
    // Half the size is no smaller than the loops: that stays as it is.
    const [half, low] = [Math.max(1, image.width >> 1), Math.max(1, image.height >> 1)];
    const context = /** @type {OffscreenCanvasRenderingContext2D} */ (new OffscreenCanvas(half, low).getContext("2d"));
    context.drawImage(image, 0, 0, half, low);
    let picture = lit(context.getImageData(0, 0, half, low));
    for (let level = 2; picture.width > 1 || picture.height > 1; level++) {
      picture = smaller(picture);
      const { width, height } = picture;
      this.texSubImage2D(target, level, 0, 0, width, height, this.RGBA, this.UNSIGNED_BYTE, bytes(picture));
    }
    image = null;
  };
})();
