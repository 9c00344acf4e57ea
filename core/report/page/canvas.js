// A canvas that shows two pictures of one size divided by a wipe, or one; with zoom and pan.

class PictureView {
  /** `onPixel(x, y)` is called with the picture's pixel under the pointer, or with nothing. */
  constructor(onPixel, onZoom) {
    this.onPixel = onPixel;
    this.onZoom = onZoom;
    this.left = this.right = null;  // canvases
    this.outline = null;
    this.zoom = null;  // CSS pixels per picture pixel; null: fit
    this.centre = [0.5, 0.5];  // of the view, as a part of the picture
    this.wipe = 0.5;  // part of the visible picture that is `left`'s
    this.canvas = el('canvas', {id: 'viewer-canvas', tabindex: 0, role: 'img', 'aria-label': 'picture'});
    this.handle = el('div', {id: 'wipe-handle', class: 'wipe', role: 'slider', tabindex: 0, 'aria-label': 'wipe between A and B',
      'aria-valuemin': 0, 'aria-valuemax': 100}, el('i', {}));
    this.element = el('div', {class: 'stage'}, this.canvas, this.handle);
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  /** Pictures to show; `right` null: `left` alone. `outline` is a box in parts of the picture. */
  show(left, right, outline = null) {
    [this.left, this.right, this.outline] = [left, right, outline];
    this.draw();
  }

  get size() { return [this.element.clientWidth, this.element.clientHeight]; }
  get fitZoom() {
    if (!this.left) return 1;
    const [width, height] = this.size, fit = Math.min(width / this.left.width, height / this.left.height);
    return fit >= 1 ? Math.floor(fit) : fit;
  }
  get scale() { return this.zoom ?? this.fitZoom; }

  /** The picture's left upper corner in CSS pixels. */
  get origin() {
    return this.size.map((length, i) => {
      const picture = (i === 0 ? this.left.width : this.left.height) * this.scale;
      return Math.round(length / 2 - (this.zoom === null ? 0.5 : this.centre[i]) * picture);
    });
  }

  /** The picture's visible span, in CSS pixels. */
  get span() {
    const x = this.origin[0];
    return [Math.max(0, x), Math.min(this.size[0], x + this.left.width * this.scale)];
  }

  draw() {
    const [width, height] = this.size, ratio = window.devicePixelRatio || 1;
    if (width === 0) return;
    const device = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== device[0] || this.canvas.height !== device[1]) [this.canvas.width, this.canvas.height] = device;
    const context = this.canvas.getContext('2d');
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, ...device);
    this.handle.hidden = !this.left || !this.right;
    if (!this.left) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.imageSmoothingEnabled = this.scale < 1;
    context.imageSmoothingQuality = 'high';
    this.paint(context, this.left);
    if (this.right) {
      const [from, to] = this.span, x = from + this.wipe * (to - from);
      context.save();
      context.beginPath();
      context.rect(x, 0, width - x, height);
      context.clip();
      this.paint(context, this.right);
      context.restore();
      this.handle.style.left = `${x}px`;
      this.handle.setAttribute('aria-valuenow', String(Math.round(this.wipe * 100)));
    }
    if (this.outline) this.drawOutline(context);
    this.canvas.dataset.zoom = this.scale;
    this.onZoom(this.scale, this.zoom === null);
  }

  paint(context, picture) {
    context.drawImage(picture, ...this.origin, picture.width * this.scale, picture.height * this.scale);
  }

  drawOutline(context) {
    const [x, y] = this.origin, width = this.left.width * this.scale, height = this.left.height * this.scale;
    const box = [x + this.outline.x * width, y + this.outline.y * height, this.outline.width * width, this.outline.height * height];
    for (const [style, line] of [['rgba(0,0,0,0.6)', 3], ['rgba(255,255,255,0.9)', 1]]) {
      context.strokeStyle = style;
      context.lineWidth = line;
      context.strokeRect(...box);
    }
  }

  /** Zooms to `scale`, keeping the point at (x, y) of the view where it is. */
  zoomTo(scale, x = this.size[0] / 2, y = this.size[1] / 2) {
    if (!this.left) return;
    const [ox, oy] = this.origin, before = this.scale, fit = this.fitZoom;
    if (scale === null || scale < Math.min(1, fit)) this.zoom = null;
    else this.zoom = Math.min(32, scale);
    const after = this.scale, [width, height] = this.size;
    const part = [(x - ox) / before / this.left.width, (y - oy) / before / this.left.height];
    this.centreAt(part[0] + (width / 2 - x) / after / this.left.width, part[1] + (height / 2 - y) / after / this.left.height);
  }
  /** To the next power of two. */
  zoomBy(direction, x, y) {
    const power = Math.log2(this.scale);
    this.zoomTo(2 ** (direction > 0 ? Math.floor(power + 1 + 1e-9) : Math.ceil(power - 1 - 1e-9)), x, y);
  }

  /** Moves a point of the picture to the view's middle; some of the picture stays in sight. */
  centreAt(x, y) {
    this.centre = [x, y].map((part) => Math.max(0, Math.min(1, part)));
    this.draw();
  }

  panBy(dx, dy) {
    if (!this.left) return;
    const [x, y] = this.origin, [width, height] = this.size;
    this.zoom = this.scale;
    this.centreAt((width / 2 - x - dx) / this.scale / this.left.width, (height / 2 - y - dy) / this.scale / this.left.height);
  }

  wipeTo(part) {
    this.wipe = Math.max(0, Math.min(1, part));
    this.draw();
  }

  listen() {
    this.handle.addEventListener('pointerdown', (event) => {
      this.handle.setPointerCapture(event.pointerId);
      event.preventDefault();
      this.handle.focus({preventScroll: true});
    });
    this.handle.addEventListener('pointermove', (event) => {
      if (!this.handle.hasPointerCapture(event.pointerId)) return;
      const [from, to] = this.span;
      this.wipeTo((event.clientX - this.element.getBoundingClientRect().left - from) / (to - from));
    });
    this.handle.addEventListener('keydown', (event) => {
      const step = event.shiftKey ? 0.1 : 0.01;
      const part = {ArrowLeft: this.wipe - step, ArrowRight: this.wipe + step, Home: 0, End: 1}[event.key];
      if (part === undefined) return;
      this.wipeTo(part);
      event.preventDefault();
      event.stopPropagation();
    });
    this.listenToCanvas();
  }

  listenToCanvas() {
    let last = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      last = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener('pointerup', () => { last = null; });
    this.canvas.addEventListener('pointercancel', () => { last = null; });
    this.canvas.addEventListener('pointermove', (event) => {
      if (last) this.panBy(event.clientX - last[0], event.clientY - last[1]);
      if (last) last = [event.clientX, event.clientY];
      this.tellPixel(event);
    });
    this.canvas.addEventListener('pointerleave', () => this.onPixel());
    // The wheel scrolls the page until the picture has the focus; then, and with Ctrl or a pinch, it zooms.
    this.canvas.addEventListener('wheel', (event) => {
      if (document.activeElement !== this.canvas && !event.ctrlKey) return;
      event.preventDefault();
      const box = this.element.getBoundingClientRect();
      this.zoomBy(event.deltaY < 0 ? 1 : -1, event.clientX - box.left, event.clientY - box.top);
    }, {passive: false});
    this.canvas.addEventListener('keydown', (event) => {
      const moves = {ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40]};
      if (event.key in moves) this.panBy(...moves[event.key]);
      else if (event.key === '+' || event.key === '=') this.zoomBy(1);
      else if (event.key === '-') this.zoomBy(-1);
      else if (event.key === '0') this.zoomTo(null);
      else return;
      event.preventDefault();
    });
  }

  tellPixel(event) {
    if (!this.left) return;
    const box = this.element.getBoundingClientRect(), [ox, oy] = this.origin;
    const x = Math.floor((event.clientX - box.left - ox) / this.scale), y = Math.floor((event.clientY - box.top - oy) / this.scale);
    if (x >= 0 && y >= 0 && x < this.left.width && y < this.left.height) this.onPixel(x, y);
    else this.onPixel();
  }
}
