//! A whole scene for other programs: its surfaces, and where they can be said its camera and its lights.
//!
//! Meshes and triangles go over exactly: the same `f32` positions, in the same order, so that the ids of a scene of
//! triangles stay. What a program cannot express is replaced by what comes nearest, and [`Export::notes`] say so; the
//! camera alone is never nearly right: where it cannot be said, [`export`] is an error, or the notes name it.

mod corners;
mod error;
mod gltf;
mod instances;
mod lights;
mod mitsuba;
mod mtl;
mod pbrt;
mod pictures;
mod pieces;
mod srgb;
mod target;
#[cfg(test)]
mod tests;

pub use error::ExportError;
pub use target::Target;

use crate::common::{Shape, View};
use crate::formats::{obj, ply};
use error::{MOST_COPIED, MOST_PLACED};
use pieces::Pieces;

/// A scene in the words of another program.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// The files, each with its name in one folder. The first one is to be opened, and names the others.
    pub files: Vec<(String, Vec<u8>)>,
    /// What is not as in the scene, each in a sentence.
    pub notes: Vec<String>,
}

/// The view's scene in the words of a program. `name` becomes the name of its file, without the ending.
///
/// # Errors
///
/// A camera that the program cannot express, and a scene without objects: see [`ExportError`].
///
/// ```
/// use bothways_lab::common::{Camera, View};
/// use bothways_lab::export::{Target, export};
/// use bothways_lab::formats::source::{GivenFile, InputFile};
/// use bothways_lab::scenes;
///
/// let loaded = scenes::load("ties")?;
/// let camera = Camera::new(loaded.camera)?;
/// let exported = export(&View::new(&loaded.scene, &camera), "ties", Target::Obj)?;
/// let (name, text) = &exported.files[0];
/// let file = GivenFile::new(name, text);
/// let again = scenes::load_file(&InputFile::given(&[file], 0), None)?;
/// assert_eq!(again.scene.primitive_count(), loaded.scene.primitive_count());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn export(view: &View, name: &str, target: Target) -> Result<Export, ExportError> {
    if view.scene.primitive_count() == 0 {
        return Err(ExportError::Empty);
    }
    check_instances(view, target)?;
    let pieces = Pieces::of(view, target);
    let file = format!("{name}.{}", target.ending());
    let mut notes = pieces.notes.clone();
    let files = match target {
        Target::Pbrt => pbrt::files(view, &pieces, name, &mut notes)?,
        Target::Mitsuba => mitsuba::files(view, &pieces, name, &mut notes)?,
        Target::Gltf => vec![(file, gltf::binary(view, &pieces, &mut notes)?)],
        Target::Obj => {
            notes.push("OBJ has no camera and no lights".into());
            obj_files(&pieces, name, &mut notes)?
        }
        Target::Ply => {
            notes.push("PLY has no camera, no lights and no materials".into());
            let mut bytes = Vec::new();
            ply::write(&pieces.merged(target, |_| None)?, &mut bytes)?;
            vec![(file, bytes)]
        }
    };
    Ok(Export { files, notes })
}

/// Refuses instances that would take too much memory, as copies or as places.
fn check_instances(view: &View, target: Target) -> Result<(), ExportError> {
    let (mut triangles, mut places) = (0, 0);
    for object in view.scene.objects() {
        if let Shape::Instances(instances) = &object.shape {
            let copied = instances::copies(target, instances);
            triangles += copied as u64 * instances.mesh().triangles().len() as u64;
            places += (instances.placements().len() - copied) as u64;
        }
    }
    if triangles > MOST_COPIED {
        return Err(ExportError::Copies { triangles });
    }
    if places > MOST_PLACED { Err(ExportError::Places { places }) } else { Ok(()) }
}

/// The mesh, its materials and their pictures.
fn obj_files(
    pieces: &Pieces,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let mut library = mtl::Library::new(name);
    let mesh = pieces.merged(Target::Obj, |piece| Some(library.name_of(piece)))?;
    let file = format!("{name}.mtl");
    let mut materials = mesh.materials().cloned().unwrap_or_default();
    materials.add_library(&file);
    let mut bytes = Vec::new();
    obj::write(&mesh.with_materials(materials), &mut bytes)?;
    notes.extend(library.note());
    let mut files = vec![(format!("{name}.obj"), bytes)];
    files.extend(library.files(file));
    Ok(files)
}
