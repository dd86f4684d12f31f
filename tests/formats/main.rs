//! Files as users bring them to the program: meshes, streams, and files that mean harm.
//!
//! What concerns the readers alone is tested in `formats/tests/`.

mod hostile_files;
mod mesh;
mod ply;
mod stream;
