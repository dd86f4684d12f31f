//! The `[material.NAME]` tables. The documentation of [`scene_file`](super) lists their keys.

use super::color::color;
use super::document::Item;
use super::error::Problem;
use bothways_common::Checker;
use bothways_common::scene::Material;
use std::collections::BTreeMap;

/// Materials by name.
pub(super) type Materials = BTreeMap<String, Material>;

/// Reads all materials.
pub(super) fn materials(item: &Item) -> Result<Materials, Problem> {
    item.entries()?.map(|item| Ok((item.name.clone(), material(&item)?))).collect()
}

fn material(item: &Item) -> Result<Material, Problem> {
    let table = item.table(&["color", "specular", "shininess", "checker"])?;
    let mut material = Material::default();
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
