//! Reads material files (MTL), which OBJ files name.
//!
//! The reader takes this part of the format (Wavefront, "MTL Material Format", 1995), and is strict about it:
//!
//! - `newmtl name` begins a material, which the statements after it describe. A name may contain blanks.
//! - `Kd r g b` and `Ks r g b` are the diffuse colour and the colour of the highlight, from 0 to 1. One number alone
//!   is grey. In place of the numbers, `xyz` or `spectral` may stand: such a `Kd` is not read, with a warning, and such a `Ks` is skipped.
//! - `Ns s` is the exponent of the highlight. The format defines it with the half vector, as we do.
//! - `map_Kd [options] file` is a texture, by its path from the material file; of its options, `-clamp on` and the first two
//!   numbers of `-s` count. It is read with mipmaps, and stands in place of `Kd`: the format would multiply the two, but programs
//!   write any grey beside a picture and show the picture alone. One that is missing, or in a format that is not read, is a warning.
//!
//! All other statements (ambient colour, transparency, other maps, extensions of other programs) are skipped.
//!
//! The format does not say whether its colours are linear. `Kd` is read as an sRGB colour: the programs that most of
//! these files were made with and for wrote these numbers to the screen unchanged. So a surface that faces the light
//! has the colour that its author saw. (Files of programs that write linear values look darker.) `Ks` becomes one
//! strength, the mean of its three numbers. `Ns 0` would light the whole surface, but programs write it for matt
//! surfaces. So it removes the highlight.

use super::error::{ReadObjError, StatementFault};
use super::file::ObjFile;
use super::statements::Statements;
use super::words::{Words, is_text, number};
use crate::picture::ReadTextureError;
use crate::picture::texture::{Pictures, has_known_ending};
use crate::source::InputFile;
use crate::source::quote::quote;
use crate::warning::{MaterialWarning, Missing};
use bothways_common::look::color::linear_from_encoded;
use bothways_common::scene::{Material, Mesh, Sampler, Texture, Wrap};
use glam::Vec3;

/// Gives a mesh its materials, from the files that its own file names, and returns warnings about missing ones.
///
/// # Errors
///
/// A material file exists but cannot be read, or is wrong.
pub(super) fn resolve(
    mesh: &mut Mesh,
    input: &InputFile,
) -> Result<Vec<MaterialWarning>, ReadObjError> {
    let (mut warnings, mut of_materials) = (Vec::new(), Vec::new());
    let libraries = match mesh.materials() {
        Some(materials) if !materials.spans().is_empty() => materials.libraries().to_vec(),
        _ => return Ok(warnings),
    };
    let file = input.name();
    for library in libraries {
        let library = with_slashes(&library);
        let found = match library_files(input, &library) {
            Ok(found) => found,
            Err(why) => {
                warnings.push(MaterialWarning::MissingLibrary { file: file.clone(), library, why });
                continue;
            }
        };
        for found in found {
            of_materials.extend(define(mesh, &found)?);
        }
    }
    let named = mesh.materials().map_or(&[][..], |materials| materials.named());
    let undefined = named.iter().filter(|named| named.material.is_none());
    let names: Vec<String> = undefined.map(|named| named.name.clone()).collect();
    summarize(&mut warnings, &file);
    // The missing file may define the missing materials: one warning is enough.
    if !names.is_empty() && warnings.is_empty() {
        warnings.push(MaterialWarning::Undefined { file, names });
    }
    warnings.append(&mut of_materials);
    Ok(warnings)
}

/// Gives a mesh the materials of one file that it has triangles of, and returns warnings about what of them is not drawn.
fn define(mesh: &mut Mesh, file: &InputFile) -> Result<Vec<MaterialWarning>, ReadObjError> {
    let (mut pictures, mut grey) = (Pictures::default(), Vec::new());
    let mut first = None;
    for (name, read) in read_materials(file)? {
        if !is_used(mesh, &name) {
            continue;
        }
        let unread_color = read.unread_color;
        let material = read.with_picture(file, &mut pictures)?;
        if unread_color.is_some() && material.texture.is_none() {
            first = first.or(unread_color);
            grey.push(name.clone());
        }
        mesh.define_material(&name, material);
    }
    let colors =
        first.map(|line| MaterialWarning::UnreadColors { file: file.name(), line, names: grey });
    Ok(colors.into_iter().chain(pictures.warnings(&file.name())).collect())
}

/// The name of a file that programs wrote with the separators of their own system.
fn with_slashes(name: &str) -> String {
    name.replace('\\', "/")
}

/// Puts one warning in the place of all but the first missing material files.
fn summarize(warnings: &mut Vec<MaterialWarning>, file: &str) {
    const MOST: usize = 8;
    let more = warnings.len().saturating_sub(MOST);
    if more > 0 {
        warnings.truncate(MOST);
        warnings.push(MaterialWarning::MissingLibraries { file: file.to_owned(), more });
    }
}

/// The files that an `mtllib` names: one file, whose name may contain blanks, or several files, separated by blanks; or why
/// one of them is missing.
fn library_files<'f>(input: &InputFile<'f>, library: &str) -> Result<Vec<InputFile<'f>>, Missing> {
    let existing = |name: &str| {
        let found = input.files().find(name);
        let found = found.map_err(|error| error.missing().unwrap_or(Missing::Absent))?;
        if found.is_file() { Ok(found) } else { Err(Missing::Absent) }
    };
    match existing(library) {
        Ok(whole) => Ok(vec![whole]),
        Err(_) => library.split_whitespace().map(existing).collect(),
    }
}

/// Reads materials and their names from the bytes of an MTL file, which messages call `name`. No picture is read.
///
/// # Errors
///
/// A statement that is wrong.
///
/// ```
/// use bothways_formats::obj;
///
/// let materials = obj::parse_materials("a.mtl", b"newmtl red\nKd 1 0 0\nNs 20\n")?;
/// assert_eq!((materials[0].0.as_str(), materials[0].1.shininess), ("red", 20.0));
///
/// let error = obj::parse_materials("a.mtl", b"newmtl red\nKd 255 0 0\n").unwrap_err();
/// assert_eq!(error.to_string(), "a.mtl:2: Kd has the value 255; it must be from 0 to 1");
/// # Ok::<(), obj::ReadObjError>(())
/// ```
pub fn parse_materials(name: &str, bytes: &[u8]) -> Result<Vec<(String, Material)>, ReadObjError> {
    let materials = materials_in(name, bytes)?;
    Ok(materials.into_iter().map(|(name, read)| (name, read.material)).collect())
}

fn materials_in(name: &str, bytes: &[u8]) -> Result<Vec<(String, ReadMaterial)>, ReadObjError> {
    let mut materials = Vec::new();
    for (line, words) in Statements::new(bytes) {
        statement(&mut materials, line, words).map_err(|fault| ReadObjError::Statement {
            file: name.to_owned(),
            line,
            fault,
        })?;
    }
    Ok(finished(materials))
}

/// Reads materials and their names from an MTL file; from the disk, one statement at a time.
fn read_materials(file: &InputFile) -> Result<Vec<(String, ReadMaterial)>, ReadObjError> {
    if let Some(bytes) = file.in_memory() {
        return materials_in(&file.name(), bytes);
    }
    let mut materials = Vec::new();
    ObjFile::open(file.path())?.statements(|line, words| statement(&mut materials, line, words))?;
    Ok(finished(materials))
}

/// A material, and the picture that it names.
#[derive(Default)]
struct ReadMaterial {
    material: Material,
    map: Option<Map>,
    /// The line that states its colour, if it is not read.
    unread_color: Option<usize>,
}

/// A picture as a statement names it, and how it is read.
struct Map {
    /// The line of the statement.
    line: usize,
    name: String,
    sampler: Sampler,
}

impl ReadMaterial {
    /// The material with its picture, unless that is missing or in a format that is not read.
    fn with_picture(
        self,
        file: &InputFile,
        pictures: &mut Pictures,
    ) -> Result<Material, ReadObjError> {
        let ReadMaterial { mut material, map, .. } = self;
        let Some(Map { line, name, sampler }) = map else { return Ok(material) };
        let name = with_slashes(&name);
        let read = pictures.of_file(file.files(), &name);
        let missing = match &read {
            Err(ReadTextureError::Find(error)) => error.missing(),
            Err(ReadTextureError::NotAPicture { .. }) if !has_known_ending(&name) => {
                Some(Missing::Unread)
            }
            _ => None,
        };
        if let Some(why) = missing {
            pictures.miss(&name, why, Some(line));
            return Ok(material);
        }
        let wrong = |error| ReadObjError::Picture { file: file.name(), line, error };
        material.texture = Some(Texture { pyramid: read.map_err(wrong)?, sampler });
        // The picture shows in its own colours.
        material.color = Vec3::ONE;
        Ok(material)
    }
}

/// Whether a mesh has triangles of a material that is not defined yet.
fn is_used(mesh: &Mesh, name: &str) -> bool {
    let named = mesh.materials().map_or(&[][..], |materials| materials.named());
    named.iter().any(|named| named.material.is_none() && named.name == name)
}

/// The picture that a statement names behind its options; `None` if it names none.
fn map_of(line: usize, mut words: Words) -> Option<Map> {
    let mut sampler = Sampler::MIPMAPS;
    loop {
        let mut rest = words.clone();
        let option = rest.next()?;
        let Some(option) = option.strip_prefix(b"-") else { break };
        // How many words at most belong to an option; those of some may be fewer.
        let (most, are_numbers) = match option {
            b"s" | b"o" | b"t" => (3, true),
            b"mm" => (2, false),
            b"blendu" | b"blendv" | b"boost" | b"texres" | b"clamp" | b"bm" | b"imfchan"
            | b"cc" | b"type" => (1, false),
            _ => (0, false),
        };
        for k in 0..most {
            let Some(word) = rest.clone().next() else { break };
            let value = number(word).ok().filter(|_| are_numbers);
            if are_numbers && value.is_none() {
                break;
            }
            match (option, value) {
                (b"s", Some(tiles)) if k < 2 && tiles > 0.0 => sampler.tiles[k] = tiles,
                (b"clamp", _) if word == b"on" => sampler.wrap = [Wrap::Clamp; 2],
                _ => {}
            }
            rest.next();
        }
        words = rest;
    }
    words.text().map(|name| Map { line, name, sampler })
}

/// Removes the highlight of materials with `Ns 0`, at the end of a file.
fn finished(mut materials: Vec<(String, ReadMaterial)>) -> Vec<(String, ReadMaterial)> {
    for (_, ReadMaterial { material, .. }) in &mut materials {
        if material.shininess == 0.0 {
            material.specular = 0.0;
            material.shininess = Material::default().shininess;
        }
    }
    materials
}

/// Parses one statement.
fn statement(
    materials: &mut Vec<(String, ReadMaterial)>,
    line: usize,
    mut words: Words,
) -> Result<(), StatementFault> {
    let Some(keyword) = words.next() else { return Ok(()) };
    match keyword {
        b"newmtl" => match words.text() {
            None => return Err(StatementFault::NoName),
            Some(name) => materials.push((name, ReadMaterial::default())),
        },
        b"Kd" | b"Ks" | b"Ns" => {
            let read = last(materials, keyword)?;
            let is_color = keyword != b"Ns";
            let is_unread = is_color && matches!(words.clone().next(), Some(b"xyz" | b"spectral"));
            if keyword == b"Kd" {
                read.unread_color = is_unread.then_some(line);
            }
            if !is_unread {
                describe(&mut read.material, keyword, words)?;
            }
        }
        b"map_Kd" => last(materials, keyword)?.map = map_of(line, words),
        _ if !is_text(keyword) => return Err(StatementFault::NotText),
        _ => {}
    }
    Ok(())
}

/// Applies a statement of numbers to a material.
fn describe(material: &mut Material, keyword: &[u8], words: Words) -> Result<(), StatementFault> {
    match keyword {
        b"Kd" => material.color = color(keyword, words)?.map(linear_from_encoded),
        b"Ks" => material.specular = color(keyword, words)?.element_sum() / 3.0,
        _ => material.shininess = one_number(keyword, words)?,
    }
    Ok(())
}

/// The material that a statement describes: the one of the last `newmtl`.
fn last<'a>(
    materials: &'a mut [(String, ReadMaterial)],
    keyword: &[u8],
) -> Result<&'a mut ReadMaterial, StatementFault> {
    let last = materials.last_mut().map(|(_, material)| material);
    last.ok_or_else(|| StatementFault::NoMaterial { keyword: quote(keyword) })
}

/// Reads a colour: three numbers from 0 to 1, or one for a grey.
fn color(keyword: &[u8], words: Words) -> Result<Vec3, StatementFault> {
    let mut values = Vec::with_capacity(3);
    for word in words.take(3) {
        match number(word)? {
            value if (0.0..=1.0).contains(&value) => values.push(value),
            _ => return Err(out_of_bounds(keyword, word, "from 0 to 1")),
        }
    }
    match values[..] {
        [red, green, blue] => Ok(Vec3::new(red, green, blue)),
        [grey] => Ok(Vec3::splat(grey)),
        _ => Err(StatementFault::MissingNumbers {
            keyword: quote(keyword),
            needed: "one number, or three",
        }),
    }
}

/// Reads one number that is not negative.
fn one_number(keyword: &[u8], mut words: Words) -> Result<f32, StatementFault> {
    let Some(word) = words.next() else {
        return Err(StatementFault::MissingNumbers { keyword: quote(keyword), needed: "a number" });
    };
    match number(word)? {
        value if value >= 0.0 => Ok(value),
        _ => Err(out_of_bounds(keyword, word, "at least 0")),
    }
}

fn out_of_bounds(keyword: &[u8], word: &[u8], range: &'static str) -> StatementFault {
    StatementFault::OutOfBounds { keyword: quote(keyword), text: quote(word), range }
}
