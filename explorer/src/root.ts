// The folder of the pages' files: pages of a language are one level deeper.

const here = import.meta.url;

/** Returns the address of one of the pages' files; scripts are in a folder beside them. */
export function rooted(file: string): string {
  return new URL(`../${file}`, here).href;
}
