/** The one time that every view of the page shows. */
export class Player {
  time: number;
  playing = false;
  /** Seconds of film for a second of the run. */
  slowdown: number;
  private readonly listeners: ((time: number) => void)[] = [];
  private lastTick = 0;

  constructor(
    public start: number,
    public end: number,
  ) {
    this.time = start;
    this.slowdown = Player.niceSlowdown(12 / Math.max(end - start, 1e-9));
  }

  static readonly slowdowns = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000];
  private static niceSlowdown(wanted: number): number {
    return Player.slowdowns.reduce((best, s) =>
      Math.abs(Math.log(s / wanted)) < Math.abs(Math.log(best / wanted)) ? s : best,
    );
  }

  onChange(listener: (time: number) => void): void {
    this.listeners.push(listener);
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, this.start), this.end);
    for (const listener of this.listeners) listener(this.time);
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  pause(): void {
    this.playing = false;
    this.seek(this.time);
  }

  private play(): void {
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    this.lastTick = performance.now();
    requestAnimationFrame(this.tick);
  }

  private readonly tick = (now: number): void => {
    if (!this.playing) return;
    const elapsed = Math.max(now - this.lastTick, 0) / 1000;
    this.lastTick = now;
    if (this.time + elapsed / this.slowdown >= this.end) this.playing = false;
    this.seek(this.time + elapsed / this.slowdown);
    requestAnimationFrame(this.tick);
  };
}
