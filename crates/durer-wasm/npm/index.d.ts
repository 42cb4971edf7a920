/** How a picture is made. */
export interface Options {
  /** Name of the file, by whose suffix formats are known that do not tell themselves; `model` by default. */
  name?: string;
  /** Width and height in pixels; 640 and 480 by default. */
  width?: number;
  height?: number;
  /** Direction to the eye, in degrees: around the up axis from the front (30 by default), and above the horizon (20). */
  azimuth?: number;
  elevation?: number;
  /** Method that finds visible surfaces, one of `methods()`; `z-buffer` by default. */
  method?: string;
}

/**
 * Renders a model to a PNG: glTF (GLB), OBJ, STL, PLY, 3MF, COLLADA, OFF, and points. The same model and options give the
 * same bytes everywhere.
 *
 * @throws {Error} If the model cannot be read, naming the place, or an option is wrong.
 */
export function render(model: Uint8Array | ArrayBuffer, options?: Options): Uint8Array;

/** Returns the methods that find visible surfaces. */
export function methods(): { name: string; title: string; titles: { en: string; de: string } }[];
