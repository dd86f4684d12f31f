//! The `[material.NAME]` tables. The documentation of [`scene_file`](super) lists their keys.

use super::color::color;
use super::document::Item;
use super::error::Problem;
use super::suggestion::suggestion;
use crate::picture::texture::Pictures;
use crate::source::Files;
use crate::source::quote::quoted;
use bothways_common::Checker;
use bothways_common::scene::{Material, Sampler, Texture, Wrap};
use glam::Vec3;
use std::collections::BTreeMap;

/// Materials by name.
pub(super) type Materials = BTreeMap<String, Material>;

/// Reads all materials, and the pictures that they name.
pub(super) fn materials(item: &Item, files: &Files) -> Result<Materials, Problem> {
    let mut pictures = Pictures::default();
    let mut read = |item: Item| Ok((item.name.clone(), material(&item, files, &mut pictures)?));
    item.entries()?.map(&mut read).collect()
}

fn material(item: &Item, files: &Files, pictures: &mut Pictures) -> Result<Material, Problem> {
    let table = item.table(&["color", "specular", "shininess", "checker", "texture"])?;
    let mut material = Material::default();
    if let Some(item) = table.get("texture") {
        if table.get("checker").is_some() {
            let message = "a material takes one of checker and texture, and this one has both";
            let help = "remove one of them";
            return Err(Problem::new(table.span_of("texture"), message).help(help));
        }
        material.texture = Some(texture(&item, files, pictures)?);
        // The picture shows in its own colours.
        material.color = Vec3::ONE;
    }
    if let Some(item) = table.get("color") {
        material.color = color(&item)?;
    }
    if let Some(item) = table.get("specular") {
        material.specular = match item.not_negative()? {
            specular if specular <= 1.0 => specular,
            _ => {
                let what = format!("is {}; it must be at most 1", item.written());
                return Err(item.problem(what));
            }
        };
    }
    if let Some(item) = table.get("shininess") {
        material.shininess = item.positive()?;
    }
    material.checker = table.get("checker").map(|item| checker(&item)).transpose()?;
    Ok(material)
}

/// Reads a checker pattern.
fn checker(item: &Item) -> Result<Checker, Problem> {
    const EXAMPLE: &str = "checker = { color = \"#202020\", divisions = [8, 8] }";
    let table = item.table(&["color", "divisions"])?;
    Ok(Checker {
        color: color(&table.need("color", EXAMPLE)?)?,
        divisions: table.need("divisions", EXAMPLE)?.positive_pair()?,
    })
}

/// Reads a texture: the name of its file alone, or a table.
fn texture(item: &Item, files: &Files, pictures: &mut Pictures) -> Result<Texture, Problem> {
    const EXAMPLE: &str = "texture = { file = \"tiles.png\", filter = \"bilinear\" }";
    let (file, sampler) = if item.is_table() {
        let table = item.table(&["file", "filter", "wrap", "tiles"])?;
        let mut sampler =
            table.get("filter").map_or(Ok(Sampler::BILINEAR), |item| filter(&item))?;
        if let Some(item) = table.get("wrap") {
            sampler.wrap = wraps(&item)?;
        }
        if let Some(item) = table.get("tiles") {
            sampler.tiles = item.positive_pair()?;
        }
        (table.need("file", EXAMPLE)?, sampler)
    } else {
        (item.clone(), Sampler::BILINEAR)
    };
    let pyramid = pictures
        .of_file(files, file.text()?)
        .map_err(|error| Problem::new(file.span.clone(), error.to_string()))?;
    Ok(Texture { pyramid, sampler })
}

fn filter(item: &Item) -> Result<Sampler, Problem> {
    let known = [
        ("nearest", Sampler::NEAREST),
        ("bilinear", Sampler::BILINEAR),
        ("mipmaps", Sampler::MIPMAPS),
    ];
    named(item, "filters", &known)
}

/// One way to wrap for both directions, or one for each.
fn wraps(item: &Item) -> Result<[Wrap; 2], Problem> {
    let known = [("repeat", Wrap::Repeat), ("clamp", Wrap::Clamp), ("mirror", Wrap::Mirror)];
    if item.is_array() {
        let [across, up] = item.elements("a word, or two words in brackets")?;
        return Ok([named(&across, "ways to wrap", &known)?, named(&up, "ways to wrap", &known)?]);
    }
    Ok([named(item, "ways to wrap", &known)?; 2])
}

/// The value of a word. Messages list all words, and call them `what`.
fn named<T: Copy>(item: &Item, what: &'static str, known: &[(&str, T)]) -> Result<T, Problem> {
    let word = item.text()?;
    known.iter().find(|(name, _)| *name == word).map(|&(_, value)| value).ok_or_else(|| {
        let names = known.iter().map(|&(name, _)| name);
        item.problem(format!("is {}", quoted(word))).help(suggestion(what, word, names))
    })
}
