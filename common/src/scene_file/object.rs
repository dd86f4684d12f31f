//! The `[[object]]` tables: one shape each, what it is made of, and where it is put.
//!
//! | key | what it says |
//! |---|---|
//! | `triangle = { a, b, c }` | its corners |
//! | `sphere = { center, radius }` | |
//! | `plane = { point, normal }` | an infinite plane |
//! | `mesh = "bunny.obj"` | a mesh file, OBJ or PLY, relative to the scene file |
//! | `generate = { kind, divisions }` | a mesh that is computed: see [`Kind`] |
//! | `material` | the name of a material; light grey without it |
//! | `scale`, `rotate = { axis, degrees }`, `translate` | where it is put, in this order |

use super::Materials;
use super::error::Problem;
use super::reader::{Item, Table, suggestion};
use super::transform::{self, Transform};
use crate::generate::Kind;
use crate::mesh_file::Format;
use crate::scene::{Material, Object, Plane, Shape, Sphere, Triangle};
use crate::smooth;
use std::path::Path;

const SHAPES: [&str; 5] = ["triangle", "sphere", "plane", "mesh", "generate"];
pub(super) const EXAMPLE: &str = "sphere = { center = [0, 0, 0], radius = 1 }";

/// Reads one object.
pub(super) fn read(item: &Item, materials: &Materials, folder: &Path) -> Result<Object, Problem> {
    let known = [&SHAPES[..], &["material"], &transform::KEYS].concat();
    let table = item.table(&known)?;
    let shape = shape(&super::exactly_one(&table, "an object", &SHAPES, EXAMPLE)?, folder)?;
    let shape = match Transform::read(&table)? {
        Some(world_from_object) => world_from_object.apply(shape)?,
        None => shape,
    };
    Ok(Object { shape, material: material(&table, materials)? })
}

fn material(object: &Table, materials: &Materials) -> Result<Material, Problem> {
    let Some(item) = object.get("material") else { return Ok(Material::default()) };
    let name = item.text()?;
    materials.get(name).copied().ok_or_else(|| {
        let problem = Problem::new(item.span.clone(), format!("there is no material {name:?}"));
        if materials.is_empty() {
            return problem.help(format!("define it in a table [material.{name}]"));
        }
        problem.help(suggestion("materials", name, materials.keys().map(String::as_str)))
    })
}

fn shape(item: &Item, folder: &Path) -> Result<Shape, Problem> {
    match item.name.as_str() {
        "triangle" => triangle(item),
        "sphere" => sphere(item),
        "plane" => plane(item),
        "mesh" => mesh(item, folder),
        _ => generated(item),
    }
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

fn mesh(item: &Item, folder: &Path) -> Result<Shape, Problem> {
    let path = Path::new(item.text()?);
    let Some(format) = Format::of(path) else {
        let problem = format!("is {:?}, which is no .obj or .ply file", path.display());
        return Err(item.problem(problem).help("convert it to OBJ or PLY; no others are read"));
    };
    let mesh = format.read(&folder.join(path));
    let smooth = |mesh| Shape::Mesh(smooth::with_normals(mesh, smooth::CREASE));
    mesh.map(smooth).map_err(|error| Problem::new(item.span.clone(), error.to_string()))
}

fn generated(item: &Item) -> Result<Shape, Problem> {
    const EXAMPLE: &str = "generate = { kind = \"torus\", divisions = [64, 32] }";
    let table = item.table(&["kind", "divisions"])?;
    let kind = table.need("kind", EXAMPLE)?;
    let name = kind.text()?;
    let Some(generated) = Kind::named(name) else {
        let kinds = Kind::ALL.into_iter().map(Kind::name);
        let problem = kind.problem(format!("is {name:?}"));
        return Err(problem.help(suggestion("kinds", name, kinds)));
    };
    let divisions = table.get("divisions");
    let counts = divisions.as_ref().map_or(Ok(generated.default_divisions()), Item::counts)?;
    let span = divisions.map_or(kind.span, |item| item.span);
    generated.mesh(counts).map(Shape::Mesh).map_err(|error| Problem::new(span, error.to_string()))
}
