// Saves the motion that is drawn as an animated GIF: with its view, forces and traces, at the chosen speed.
const gifWidth = 640, pictureTime = 0.05, mostPictures = 400;  // pixels, s

class Recorder {
  // about: {canvas, scene, player, name, say(text)}
  constructor(about) { Object.assign(this, about, {running: false}); }

  // Times of the pictures, and the delay between them in hundredths of a second.
  times() {
    const {t0, t1, rate, factor} = this.player, duration = (t1 - t0) / (rate * factor);
    const delay = Math.max(Math.round(100 * pictureTime), Math.ceil(100 * duration / mostPictures)), count = Math.max(2, Math.round(100 * duration / delay) + 1);
    return {delay, times: Array.from({length: count}, (_, k) => t0 + (t1 - t0) * k / (count - 1))};
  }

  // The drawing at a time, on the colour of the page, with the time below.
  picture(t) {
    const {canvas, scene, page, draw} = this, {width, height} = page;
    scene.show(t);
    draw.fillStyle = this.paper;
    draw.fillRect(0, 0, width, height);
    draw.drawImage(canvas, 0, 0, width, height);
    draw.fillStyle = this.ink;
    draw.font = "14px system-ui, sans-serif";
    draw.fillText("t = " + t.toPrecision(4) + " s", 10, height - 10);
    return draw.getImageData(0, 0, width, height).data;
  }

  // Returns the bytes, or null if it was stopped.
  async gif({times, delay} = this.times()) {
    const {canvas, player} = this, style = getComputedStyle(document.body), pause = () => new Promise((done) => setTimeout(done, 0));
    player.play(false);
    this.running = true;
    Object.assign(this, {page: document.createElement("canvas"), paper: style.backgroundColor, ink: style.color});
    const width = Math.min(gifWidth, canvas.width);
    Object.assign(this.page, {width, height: Math.round(canvas.height * width / canvas.width)});
    this.draw = this.page.getContext("2d", {willReadFrequently: true});
    const samples = [0, 0.25, 0.5, 0.75, 1].map((part) => this.picture(times[Math.round(part * (times.length - 1))]));
    const file = new AnimatedGif(width, this.page.height, paletteOf(samples), delay);
    for (let k = 0; k < times.length && this.running; ++k) {
      file.add(this.picture(times[k]));
      this.say("picture " + (k + 1) + " of " + times.length);
      await pause();
    }
    player.jump(player.at);
    const stopped = !this.running;
    this.running = false;
    return stopped ? null : file.bytes();
  }

  async save() {
    if (this.running) {
      this.running = false;
      return;
    }
    const bytes = await this.gif();
    if (bytes === null) {
      this.say("no file was saved");
      return;
    }
    const link = document.createElement("a");
    Object.assign(link, {href: URL.createObjectURL(new Blob([bytes], {type: "image/gif"})), download: this.name + ".gif"});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    this.say("saved " + link.download + ", " + (bytes.length / 1e6).toPrecision(3) + " MB");
  }
}
