//! The `[[light]]` tables. The documentation of [`scene_file`](super) lists their keys.

use super::document::Item;
use super::error::Problem;
use bothways_common::scene::Light;

/// Reads all lights. Each has exactly one of `directional`, `point` and `ambient`.
pub(super) fn lights(item: &Item) -> Result<Vec<Light>, Problem> {
    item.tables()?.map(|item| light(&item)).collect()
}

fn light(item: &Item) -> Result<Light, Problem> {
    const KINDS: [&str; 3] = ["directional", "point", "ambient"];
    let table = item.table(&["directional", "point", "ambient", "intensity"])?;
    let kind = table.exactly_one("a light", &KINDS, "directional = [-1, -2, -1]")?;
    let intensity = table.get("intensity").map_or(Ok(1.0), |item| item.not_negative())?;
    match kind.name.as_str() {
        "directional" => Ok(Light::Directional { direction: kind.direction()?, intensity }),
        "point" => Ok(Light::Point { position: kind.vector()?, intensity }),
        _ if kind.flag()? => Ok(Light::Ambient { intensity }),
        _ => Err(kind.problem("is false").help("write ambient = true, or remove this light")),
    }
}
