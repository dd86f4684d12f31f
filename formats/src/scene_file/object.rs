//! The `[[object]]` tables. The documentation of [`scene_file`](super) lists their keys.

use super::document::{Item, Table};
use super::error::Problem;
use super::instances;
use super::material::Materials;
use super::suggestion::suggestion;
use super::transform::{self, Transform};
use crate::generate::Kind;
use crate::mesh_file::{EXTENSIONS, Format, ReadMeshError};
use crate::smooth;
use crate::source::Files;
use crate::source::quote::{quoted, shown};
use bothways_common::scene::{
    Material, Mesh, MeshMaterials, Object, Plane, Shape, Sphere, Triangle,
};
use std::path::Path;

const SHAPES: [&str; 5] = ["triangle", "sphere", "plane", "mesh", "generate"];
pub(super) const EXAMPLE: &str = "sphere = { center = [0, 0, 0], radius = 1 }";

/// Reads one object.
pub(super) fn read(
    item: &Item,
    materials: &Materials,
    files: &Files,
    warnings: &mut Vec<String>,
) -> Result<Object, Problem> {
    let known = [&SHAPES[..], &["material", instances::KEY], &transform::KEYS].concat();
    let table = item.table(&known)?;
    let stated = table.exactly_one("an object", &SHAPES, EXAMPLE)?;
    let shape = match stated.name.as_str() {
        "triangle" => triangle(&stated)?,
        "sphere" => sphere(&stated)?,
        "plane" => plane(&stated)?,
        "mesh" => mesh(&stated, files, table.get("material").is_none(), warnings)?,
        _ => generated(&stated)?,
    };
    let shape = match Transform::read(&table)? {
        Some(world_from_object) => world_from_object.apply(shape)?,
        None => shape,
    };
    let shape = match (instances::read(&table)?, shape) {
        (None, shape) => shape,
        (Some(placements), Shape::Mesh(mesh)) => {
            Shape::Instances(instances::placed(mesh, placements, table.span_of(instances::KEY))?)
        }
        (Some(_), _) => {
            let message = format!("a {} has no instances, only a mesh has", stated.name);
            let help = "state each as an object, or use mesh or generate";
            return Err(Problem::new(table.span_of(instances::KEY), message).help(help));
        }
    };
    let material = material(&table, &shape, materials)?;
    check_pattern(&table, &shape, &material)?;
    Ok(Object { shape, material })
}

/// Makes sure that an object with a pattern has texture coordinates: without them the pattern would silently be missing.
fn check_pattern(object: &Table, shape: &Shape, material: &Material) -> Result<(), Problem> {
    let Some(mesh) = shape.mesh() else { return Ok(()) };
    if !material.has_pattern() || !mesh.texture_coordinates().corners.is_empty() {
        return Ok(());
    }
    let pattern = if material.checker.is_some() { "checker" } else { "texture" };
    let message = format!("this material has a {pattern}, and the mesh has no texture coordinates");
    Err(Problem::new(object.span_of("material"), message).help(format!(
        "export the mesh with texture coordinates, as OBJ (vt) or glTF, or choose a material without {pattern}"
    )))
}

/// The material of an object.
fn material(object: &Table, shape: &Shape, materials: &Materials) -> Result<Material, Problem> {
    let Some(item) = object.get("material") else {
        return Ok(shape.mesh().map_or_else(Material::default, Mesh::own_material));
    };
    let name = item.text()?;
    materials.get(name).cloned().ok_or_else(|| {
        let problem =
            Problem::new(item.span.clone(), format!("there is no material {}", quoted(name)));
        if materials.is_empty() {
            return problem.help(format!("define it in a table [material.{}]", key(name)));
        }
        problem.help(suggestion("materials", name, materials.keys().map(String::as_str)))
    })
}

/// A name as it is written in a TOML header: in quotation marks unless it is plain.
fn key(name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(plain) { shown(name) } else { quoted(name) }
}

fn triangle(item: &Item) -> Result<Shape, Problem> {
    const EXAMPLE: &str = "triangle = { a = [0, 0, 0], b = [1, 0, 0], c = [0, 1, 0] }";
    let table = item.table(&["a", "b", "c"])?;
    let corner = |key| table.need(key, EXAMPLE)?.vector();
    Ok(Shape::Triangle(Triangle { a: corner("a")?, b: corner("b")?, c: corner("c")? }))
}

fn sphere(item: &Item) -> Result<Shape, Problem> {
    let table = item.table(&["center", "radius"])?;
    let center = table.need("center", EXAMPLE)?.vector()?;
    Ok(Shape::Sphere(Sphere { center, radius: table.need("radius", EXAMPLE)?.positive()? }))
}

fn plane(item: &Item) -> Result<Shape, Problem> {
    const EXAMPLE: &str = "plane = { point = [0, 0, 0], normal = [0, 1, 0] }";
    let table = item.table(&["point", "normal"])?;
    let point = table.need("point", EXAMPLE)?.vector()?;
    Ok(Shape::Plane(Plane { point, normal: table.need("normal", EXAMPLE)?.direction()? }))
}

/// Reads a mesh file, with the materials that it names if `own_materials`.
fn mesh(
    item: &Item,
    files: &Files,
    own_materials: bool,
    warnings: &mut Vec<String>,
) -> Result<Shape, Problem> {
    let name = item.text()?;
    let found = files.find(name);
    let format = match &found {
        Ok(file) => Format::of_file(file),
        Err(_) => Format::of(Path::new(name)),
    };
    let Some(format) = format else {
        let problem = format!("is {}, which is no mesh file ({EXTENSIONS})", quoted(name));
        return Err(item.problem(problem).help("convert it to one of these; no others are read"));
    };
    let file = found.map_err(|error| Problem::new(item.span.clone(), error.to_string()))?;
    let wrong = |error: ReadMeshError| Problem::new(item.span.clone(), error.to_string());
    let mesh = if own_materials {
        let (mesh, missing) = format.read_with_materials(&file).map_err(wrong)?;
        warnings.extend(missing.iter().map(ToString::to_string));
        mesh
    } else {
        let mesh = format.read(&file).map_err(wrong)?.with_materials(MeshMaterials::default());
        mesh.with_colors(Vec::new()).expect("no colours fit every mesh")
    };
    Ok(Shape::Mesh(smooth::with_normals(mesh, smooth::CREASE)))
}

/// Generates a mesh.
fn generated(item: &Item) -> Result<Shape, Problem> {
    const EXAMPLE: &str = "generate = { kind = \"torus\", divisions = [64, 32] }";
    let table = item.table(&["kind", "divisions"])?;
    let kind = table.need("kind", EXAMPLE)?;
    let name = kind.text()?;
    let Some(generated) = Kind::named(name) else {
        let kinds = Kind::ALL.into_iter().map(Kind::name);
        let problem = kind.problem(format!("is {}", quoted(name)));
        return Err(problem.help(suggestion("kinds", name, kinds)));
    };
    let divisions = table.get("divisions");
    let counts = divisions.as_ref().map_or(Ok(generated.default_divisions()), Item::counts)?;
    let span = divisions.map_or(kind.span, |item| item.span);
    generated.mesh(counts).map(Shape::Mesh).map_err(|error| Problem::new(span, error.to_string()))
}
