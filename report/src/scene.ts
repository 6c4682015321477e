import {
  AmbientLight, Box3, BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry,
  DirectionalLight, DoubleSide, EdgesGeometry, Line, LineBasicMaterial, LineDashedMaterial, LineSegments, Matrix4,
  Mesh, MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, PlaneGeometry, Points, PointsMaterial, Quaternion, Scene,
  SRGBColorSpace, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { BODY_COLOURS, bodyColour, viridis } from "./colour";
import { CROWD, columnOf, hasBox, type GrainCloud, type Plate, type Raster, type Replay, type Run, type Vec3 } from "./data";
import { h } from "./dom";
import { fastestBody, grainsAt, poseAt, radius, speedAt } from "./motion";
import type { Player } from "./player";
import { AirImage, fastestAir, speedBar } from "./slice";

export function hasWebGl(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

/** What the colour of a body says. */
export type Paint = "body" | "speed";
export type View = "jet" | "flight" | "side" | "above" | "follow";

const vector = (v: Vec3): Vector3 => new Vector3(...v);

function airPlane(raster: Raster, image: AirImage): { mesh: Mesh; texture: CanvasTexture } {
  const texture = new CanvasTexture(image.canvas);
  texture.colorSpace = SRGBColorSpace;
  const [w, ht] = [raster.upper[0] - raster.lower[0], raster.upper[1] - raster.lower[1]];
  const material = new MeshBasicMaterial({ map: texture, transparent: true, side: DoubleSide, depthWrite: false });
  const mesh = new Mesh(new PlaneGeometry(w, ht), material);
  const [first, second] = [0, 1, 2].filter((d) => d !== raster.axis) as [number, number];
  const unit = (d: number): Vector3 => new Vector3().setComponent(d, 1);
  const basis = new Matrix4().makeBasis(unit(first), unit(second), unit(first).cross(unit(second)));
  const centre = new Vector3().setComponent(raster.axis, raster.position);
  centre.setComponent(first, (raster.lower[0] + raster.upper[0]) / 2);
  centre.setComponent(second, (raster.lower[1] + raster.upper[1]) / 2);
  mesh.quaternion.setFromRotationMatrix(basis);
  mesh.position.copy(centre);
  return { mesh, texture };
}

/** The plate: solid as wide as what happens in front of it, beyond that a veil that hides no path. */
function plateMeshes(p: Plate, solidWidth: number): Mesh[] {
  const [along, across] = [vector(p.along), vector(p.across)];
  const basis = new Matrix4().makeBasis(along, across, along.clone().cross(across));
  const look = { color: 0x9fb0c3, metalness: 0.6, roughness: 0.4 };
  return [
    { width: Math.min(p.width, solidWidth), material: new MeshStandardMaterial(look) },
    { width: p.width, material: new MeshStandardMaterial({ ...look, transparent: true, opacity: 0.13, depthWrite: false }) },
  ].map(({ width, material }) => {
    const mesh = new Mesh(new BoxGeometry(p.length, width, p.thickness), material);
    mesh.quaternion.setFromRotationMatrix(basis);
    mesh.position.copy(vector(p.edge)).addScaledVector(along, p.length / 2);
    return mesh;
  });
}

function pathLine(points: Vector3[], colour: string, dashed: boolean): Line {
  const geometry = new BufferGeometry().setFromPoints(points);
  const material = dashed
    ? new LineDashedMaterial({ color: colour, dashSize: 0.004, gapSize: 0.004, transparent: true, opacity: 0.6 })
    : new LineBasicMaterial({ color: colour });
  return new Line(geometry, material).computeLineDistances();
}

/** The replay in space: bodies as their true triangles, the air as coloured planes, the plate, the paths. */
export class SceneView {
  readonly canvas = h("canvas", { class: "stage", role: "img" });
  readonly legend = h("div", { class: "legend" });
  private paint: Paint = "body";
  private readonly fastest: number;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(32, 1, 0.001, 20);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly bodies: { run: Run; body: number; mesh: Mesh; look: MeshStandardMaterial; own: Color }[] = [];
  private readonly grains: { replay: Replay; points: Points }[] = [];
  private air: { image: AirImage; texture: CanvasTexture; mesh: Mesh }[] = [];
  private readonly flight = new Box3();
  private readonly domain = new Box3();
  private wanted = false;
  private placed = false;
  private followed: Mesh | undefined;
  private readonly lastSeen = new Vector3();

  constructor(
    private readonly runs: Run[],
    private readonly player: Player,
  ) {
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.camera.up.set(0, 0, 1);
    this.scene.add(new AmbientLight(0xcfe0ff, 1.2));
    const sun = new DirectionalLight(0xffffff, 2.6);
    sun.position.set(-0.4, -0.8, 1);
    this.scene.add(sun);
    const fill = new DirectionalLight(0x9fc5ff, 0.8);
    fill.position.set(0.6, 0.5, -0.3);
    this.scene.add(fill);
    runs.forEach((run, r) => this.addRun(run, r > 0));
    this.fastest = Math.max(1e-9, ...runs.map((run) => (run.replay ? fastestBody(run.replay) : 0)));
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.request());
    player.onChange(() => this.request());
    new ResizeObserver(() => this.request()).observe(this.canvas);
  }

  private addRun(run: Run, ghost: boolean): void {
    const replay = run.replay;
    if (!replay) return;
    if (!ghost) {
      const size = this.addBox(replay);
      for (const plate of replay.plates) {
        this.scene.add(...plateMeshes(plate, size.y));
        this.flight.expandByPoint(vector(plate.edge).addScaledVector(vector(plate.along), plate.length));
      }
      for (const nozzle of replay.nozzles) this.scene.add(this.nozzleMesh(nozzle.position, nozzle.direction, nozzle.diameter));
    }
    if (replay.grains) this.grains.push({ replay, points: this.grainPoints(replay.grains) });
    replay.bodies.forEach((surface, body) => {
      const colour = bodyColour(body, true);
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(surface.vertices, 3));
      geometry.setIndex(new BufferAttribute(surface.triangles, 1));
      const flat = geometry.toNonIndexed();
      flat.computeVertexNormals();
      flat.computeBoundingSphere();
      const own = new Color(0xb8b2a7).lerp(new Color(colour), 0.25);
      const look = new MeshStandardMaterial({ color: own, roughness: 0.85, transparent: ghost, opacity: ghost ? 0.45 : 1 });
      const mesh = new Mesh(flat, look);
      this.scene.add(mesh);
      this.bodies.push({ run, body, mesh, look, own });
      if (replay.bodies.length > CROWD) return;
      const points = this.pathOf(run, body);
      if (points.length > 1) this.scene.add(pathLine(points, colour, false));
      const free = (replay.undisturbed[body] ?? []).map(vector);
      if (free.length > 1) this.scene.add(pathLine(free, colour, true));
    });
  }

  /** Drawn a little larger than they are: dust of 0.1 mm would not be seen. */
  private grainPoints({ shown, diameter }: GrainCloud): Points {
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(3 * shown), 3));
    const points = new Points(geometry, new PointsMaterial({ color: 0xe0a95c, size: Math.max(2 * diameter, 0.0006) }));
    points.frustumCulled = false;
    this.scene.add(points);
    return points;
  }

  /** The box of the air with its edges, or that around all bodies; its size. */
  private addBox(replay: Replay): Vector3 {
    if (hasBox(replay)) this.domain.set(vector(replay.domain[0]), vector(replay.domain[1]));
    else {
      for (const frame of replay.frames) for (const pose of frame.poses) if (pose) this.domain.expandByPoint(vector(pose.position));
      this.domain.expandByScalar(Math.max(0, ...replay.bodies.map(radius)));
    }
    this.flight.copy(this.domain);
    const size = this.domain.getSize(new Vector3());
    if (hasBox(replay)) {
      const box = new LineSegments(new EdgesGeometry(new BoxGeometry(size.x, size.y, size.z)),
        new LineBasicMaterial({ color: 0x5b6b80, transparent: true, opacity: 0.5 }));
      this.domain.getCenter(box.position);
      this.scene.add(box);
    }
    return size;
  }

  private pathOf(run: Run, body: number): Vector3[] {
    const table = run.history.get(`body-${run.replay!.bodies[body]!.name}`);
    const [x, y, z] = ["x", "y", "z"].map((name) => table && columnOf(table, name));
    return x && y && z
      ? Array.from(x, (value, n) => new Vector3(value, y[n], z[n]))
      : run.replay!.frames.flatMap((f) => (f.poses[body] ? [vector(f.poses[body]!.position)] : []));
  }

  private nozzleMesh(position: Vec3, direction: Vec3, diameter: number): Mesh {
    const length = 0.012;
    const mesh = new Mesh(new CylinderGeometry(Math.max(diameter, 0.002), Math.max(2 * diameter, 0.006), length, 24),
      new MeshStandardMaterial({ color: 0x9fb0c3, metalness: 0.6, roughness: 0.4 }));
    mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), vector(direction)));
    mesh.position.copy(vector(position)).addScaledVector(vector(direction), -length / 2);
    return mesh;
  }

  /** Whose air is shown: all slices of that run. */
  select(run: Run): void {
    for (const a of this.air) this.scene.remove(a.mesh);
    this.air = run.replay!.rasters.map((raster, n) => {
      const image = new AirImage(run, n, fastestAir(run));
      const plane = airPlane(raster, image);
      this.scene.add(plane.mesh);
      return { image, ...plane };
    });
    this.request();
  }

  colourBy(paint: Paint): void {
    this.paint = paint;
    this.legend.replaceChildren(...(paint === "speed" ? speedBar("Speed of bodies", BODY_COLOURS, this.fastest) : []));
    this.request();
  }

  look(view: View): void {
    this.followed = view === "follow" ? this.bodies[0]?.mesh : undefined;
    if (this.followed) {
      this.moveBodies();
      this.lastSeen.copy(this.followed.position);
      const size = this.followed.geometry.boundingSphere?.radius ?? 0.01;
      this.camera.position.copy(this.lastSeen).addScaledVector(new Vector3(-0.5, -1.1, 0.45), 9 * size);
      this.controls.target.copy(this.lastSeen);
      this.controls.update();
      this.request();
    } else if (view !== "follow") this.lookAtBox(view);
  }

  private lookAtBox(view: Exclude<View, "follow">): void {
    const box = view === "jet" ? this.domain : this.flight;
    const centre = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const from = { jet: [-0.75, -1.5, 0.65], flight: [-0.45, -1.2, 0.5], side: [0, -1, 0.001], above: [0, -0.02, 1] }[view] as Vec3;
    // Far enough that the box fits in width and height.
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const reach = 0.62 * Math.max(size.x / (half * this.camera.aspect), Math.hypot(size.y, size.z) / half) + 0.5 * size.y;
    this.placed = true;
    this.camera.position.copy(centre).addScaledVector(new Vector3(...from).normalize(), reach);
    this.controls.target.copy(centre);
    this.controls.update();
    this.request();
  }

  private moveGrains(): void {
    for (const { replay, points } of this.grains) {
      const position = points.geometry.getAttribute("position") as BufferAttribute;
      grainsAt(replay, this.player.time, position.array as Float32Array);
      position.needsUpdate = true;
    }
  }

  private moveBodies(): void {
    for (const { run, body, mesh, look, own } of this.bodies) {
      const pose = poseAt(run.replay!, body, this.player.time);
      mesh.visible = pose !== undefined;
      if (!pose) continue;
      const [w, x, y, z] = pose.orientation;
      mesh.position.set(...pose.position);
      mesh.quaternion.set(x, y, z, w);
      const speed = this.paint === "speed" ? speedAt(run.replay!, body, this.player.time) : undefined;
      if (speed === undefined) look.color.copy(own);
      else {
        const [red, green, blue] = viridis(speed / this.fastest);
        look.color.setRGB(red / 255, green / 255, blue / 255, SRGBColorSpace);
      }
    }
  }

  private request(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.render();
    });
  }

  private render(): void {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.placed) this.look("jet");
    this.moveBodies();
    this.moveGrains();
    if (this.followed) {
      const step = this.followed.position.clone().sub(this.lastSeen);
      this.lastSeen.add(step);
      this.camera.position.add(step);
      this.controls.target.add(step);
      this.camera.updateMatrixWorld();
    }
    for (const { image, texture } of this.air) if (image.show(this.player.time)) texture.needsUpdate = true;
    this.renderer.render(this.scene, this.camera);
    const named = this.runs.flatMap((r) => r.replay?.bodies.map((b) => b.name) ?? []);
    this.canvas.setAttribute("aria-label", `The same in space: ${named.join(", ") || "no bodies"}, the plate and the air in its slices.`);
  }
}
