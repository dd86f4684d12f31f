//! The formats and generators against what is not their own code: formulas, another reader, and stated messages.

mod generated_meshes;
mod hostile_pictures;
mod independent_writers;
mod obj_against_tobj;
mod polygons;
mod scene_file;
mod scene_file_errors;
