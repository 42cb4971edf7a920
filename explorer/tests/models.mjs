// Small files of many formats, made here: a tetrahedron, a picture, shapes.

import { deflateSync } from "node:zlib";

const CORNERS = [
  [0, 0, 0],
  [4, 0, 0],
  [0, 4, 0],
  [1, 1, 3],
];
const FACES = [
  [0, 2, 1],
  [0, 1, 3],
  [1, 2, 3],
  [2, 0, 3],
];

const text = (lines) => Buffer.from(`${lines.join("\n")}\n`);

export const obj = text([...CORNERS.map((p) => `v ${p.join(" ")}`), ...FACES.map((face) => `f ${face.map((k) => k + 1).join(" ")}`)]);

export const ply = text([
  "ply",
  "format ascii 1.0",
  `element vertex ${CORNERS.length}`,
  ...["x", "y", "z"].map((axis) => `property float ${axis}`),
  `element face ${FACES.length}`,
  "property list uchar int vertex_indices",
  "end_header",
  ...CORNERS.map((p) => p.join(" ")),
  ...FACES.map((face) => `3 ${face.join(" ")}`),
]);

/** Binary STL. */
export const stl = Buffer.concat([
  Buffer.alloc(80),
  Buffer.from(Uint32Array.of(FACES.length).buffer),
  ...FACES.map((face) => Buffer.concat([Buffer.from(Float32Array.from([0, 0, 0, ...face.flatMap((k) => CORNERS[k])]).buffer), Buffer.alloc(2)])),
]);

/** Binary glTF: JSON and one buffer of positions and indices. */
export const glb = (() => {
  const positions = Buffer.from(Float32Array.from(CORNERS.flat()).buffer);
  const indices = Buffer.from(Uint16Array.from(FACES.flat()).buffer);
  const json = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: CORNERS.length, type: "VEC3", min: [0, 0, 0], max: [4, 4, 3] },
      { bufferView: 1, componentType: 5123, count: FACES.length * 3, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: positions.length },
      { buffer: 0, byteOffset: positions.length, byteLength: indices.length },
    ],
    buffers: [{ byteLength: positions.length + indices.length }],
  };
  const padded = (bytes, filler) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]);
  const chunk = (type, data) => Buffer.concat([Buffer.from(Uint32Array.of(data.length).buffer), Buffer.from(type, "latin1"), data]);
  const body = Buffer.concat([chunk("JSON", padded(Buffer.from(JSON.stringify(json)), " ")), chunk("BIN\0", padded(Buffer.concat([positions, indices]), 0))]);
  return Buffer.concat([Buffer.from("glTF"), Buffer.from(Uint32Array.of(2, 12 + body.length).buffer), body]);
})();

function crc(bytes) {
  let value = 0xffffffff;
  for (const byte of bytes) {
    value ^= byte;
    for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  }
  return (value ^ 0xffffffff) >>> 0;
}

/** A PNG of grey pixels, a frame of black around a light area. */
export const png = (() => {
  const [width, height] = [7, 5];
  const rows = Array.from({ length: height }, (_, y) => [0, ...Array.from({ length: width }, (_, x) => (x % (width - 1) === 0 || y % (height - 1) === 0 ? 0 : 230))]);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head[8] = 8;
  const chunk = (type, data) => {
    const own = Buffer.concat([Buffer.from(type), data]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc(own), 4);
    return Buffer.concat([ends.subarray(0, 4), own, ends.subarray(4)]);
  };
  const signature = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
  return Buffer.concat([signature, chunk("IHDR", head), chunk("IDAT", deflateSync(Buffer.from(rows.flat()))), chunk("IEND", Buffer.alloc(0))]);
})();

export const svg = text(['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><path d="M1 1L18 3L12 17L6 9Z"/></svg>']);

export const wkt = text(["POLYGON ((0 0, 12 1, 9 9, 4 3, 0 0))"]);
