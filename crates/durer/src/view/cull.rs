//! What cannot be seen: boxes and spheres outside a volume, faces turned away.
