//! The program on files from users: meshes, streams, and malicious files.
//!
//! The tests of the readers alone are in `formats/tests/`.

mod hostile_files;
mod mesh;
mod other_formats;
mod outside;
mod ply;
mod shared_meshes;
mod stream;
mod textures;
