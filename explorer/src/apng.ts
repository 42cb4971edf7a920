// Animated PNGs of runs: pictures that the browser makes, joined chunk by chunk (PNG specification, third edition, 11.3.6).

/** A picture as a PNG file and the time that it is shown, in milliseconds. */
export interface Picture {
  png: Uint8Array;
  shown: number;
}

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});

function crc(bytes: Uint8Array): number {
  let value = 0xffffffff;
  for (const byte of bytes) value = TABLE[(value ^ byte) & 255]! ^ (value >>> 8);
  return (value ^ 0xffffffff) >>> 0;
}

interface Chunk {
  type: string;
  data: Uint8Array;
}

function chunksOf(png: Uint8Array): Chunk[] {
  const view = new DataView(png.buffer, png.byteOffset, png.byteLength);
  const chunks: Chunk[] = [];
  for (let at = SIGNATURE.length; at + 12 <= png.length; ) {
    const length = view.getUint32(at);
    chunks.push({ type: String.fromCharCode(...png.subarray(at + 4, at + 8)), data: png.subarray(at + 8, at + 8 + length) });
    at += 12 + length;
  }
  return chunks;
}

function written({ type, data }: Chunk): Uint8Array {
  const bytes = new Uint8Array(12 + data.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, data.length);
  bytes.set([...type].map((letter) => letter.charCodeAt(0)), 4);
  bytes.set(data, 8);
  view.setUint32(8 + data.length, crc(bytes.subarray(4, 8 + data.length)));
  return bytes;
}

/** Returns the chunk that begins a picture of the animation. */
function control(sequence: number, [width, height]: [number, number], shown: number): Chunk {
  const data = new Uint8Array(26);
  const view = new DataView(data.buffer);
  [sequence, width, height, 0, 0].forEach((value, index) => view.setUint32(index * 4, value));
  view.setUint16(20, Math.min(65_535, Math.round(shown)));
  view.setUint16(22, 1000);
  return { type: "fcTL", data };
}

/** Joins pictures of one size and kind of pixels to an animation that repeats for ever. */
export function joined(pictures: Picture[]): Uint8Array {
  const all = pictures.map(({ png }) => chunksOf(png));
  const first = all[0] ?? [];
  const head = first.find(({ type }) => type === "IHDR")!;
  const size = new DataView(head.data.buffer, head.data.byteOffset);
  const sides: [number, number] = [size.getUint32(0), size.getUint32(4)];
  const count = new Uint8Array(8);
  new DataView(count.buffer).setUint32(0, pictures.length);
  const out: Chunk[] = [head, { type: "acTL", data: count }];
  let sequence = 0;
  all.forEach((chunks, index) => {
    out.push(control(sequence++, sides, pictures[index]!.shown));
    for (const { type, data } of chunks) {
      if (type !== "IDAT") continue;
      if (index === 0) {
        out.push({ type, data });
        continue;
      }
      const numbered = new Uint8Array(4 + data.length);
      new DataView(numbered.buffer).setUint32(0, sequence++);
      numbered.set(data, 4);
      out.push({ type: "fdAT", data: numbered });
    }
  });
  out.push({ type: "IEND", data: new Uint8Array() });
  const parts = [Uint8Array.from(SIGNATURE), ...out.map(written)];
  const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

/** Draws an SVG text on white, as large as the canvas allows, and returns the PNG. */
export async function drawn(svg: string, canvas: HTMLCanvasElement): Promise<Uint8Array> {
  const url = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = url;
    await image.decode();
    const context = canvas.getContext("2d")!;
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    const scale = Math.min(canvas.width / image.naturalWidth, canvas.height / image.naturalHeight);
    context.drawImage(image, 0, 0, image.naturalWidth * scale, image.naturalHeight * scale);
  } finally {
    URL.revokeObjectURL(url);
  }
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (!blob) throw new Error("the browser made no PNG");
  return new Uint8Array(await blob.arrayBuffer());
}
