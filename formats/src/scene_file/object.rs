//! The `[[object]]` tables. The documentation of [`scene_file`](super) lists their keys.

use super::document::{Item, Table};
use super::error::Problem;
use super::instances;
use super::material::Materials;
use super::suggestion::suggestion;
use super::transform::{self, Transform};
use crate::generate::Kind;
use crate::mesh_file::{EXTENSIONS, Format, ReadMeshError};
use crate::shapes;
use crate::smooth;
use crate::source::Files;
use crate::source::quote::{quoted, shown};
use bothways_common::scene::{
    Material, Mesh, MeshMaterials, Object, Plane, Shape, Sphere, Triangle,
};
use std::path::Path;

const SHAPES: [&str; 5] = ["triangle", "sphere", "plane", "mesh", "generate"];
pub(super) const EXAMPLE: &str = "sphere = { center = [0, 0, 0], radius = 1 }";

/// Reads what one table describes: one object, or several where a mesh file has meshes and instances of others.
pub(super) fn read(
    item: &Item,
    materials: &Materials,
    files: &Files,
    warnings: &mut Vec<String>,
) -> Result<Vec<Object>, Problem> {
    let known = [&SHAPES[..], &["material", instances::KEY], &transform::KEYS].concat();
    let table = item.table(&known)?;
    let stated = table.exactly_one("an object", &SHAPES, EXAMPLE)?;
    let shapes = match stated.name.as_str() {
        "triangle" => vec![triangle(&stated)?],
        "sphere" => vec![sphere(&stated)?],
        "plane" => vec![plane(&stated)?],
        "mesh" => mesh(&stated, &table, files, warnings)?,
        _ => vec![generated(&stated)?],
    };
    let shapes = match Transform::read(&table)? {
        Some(world_from_object) => shapes
            .into_iter()
            .map(|shape| world_from_object.apply(shape))
            .collect::<Result<_, _>>()?,
        None => shapes,
    };
    let shapes = match instances::read(&table)? {
        None => shapes,
        Some(placements) => {
            let span = table.span_of(instances::KEY);
            let mut shapes = shapes.into_iter();
            let (Some(Shape::Mesh(mesh)), None) = (shapes.next(), shapes.next()) else {
                let message = format!("a {} has no instances, only a mesh has", stated.name);
                let help = "state each as an object, or use mesh or generate";
                return Err(Problem::new(span, message).help(help));
            };
            vec![Shape::Instances(instances::placed(mesh, placements, span)?)]
        }
    };
    let material = material(&table, &shapes, materials)?;
    for shape in &shapes {
        check_pattern(&table, shape, &material)?;
    }
    let object = |shape| Object { shape, material: material.clone() };
    Ok(shapes.into_iter().map(object).collect())
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
fn material(object: &Table, shapes: &[Shape], materials: &Materials) -> Result<Material, Problem> {
    let Some(item) = object.get("material") else { return Ok(shapes::own_material(shapes)) };
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
    let table = item.table_such_as(&["a", "b", "c"], EXAMPLE)?;
    let corner = |key| table.need(key, EXAMPLE)?.vector();
    Ok(Shape::Triangle(Triangle { a: corner("a")?, b: corner("b")?, c: corner("c")? }))
}

fn sphere(item: &Item) -> Result<Shape, Problem> {
    let table = item.table_such_as(&["center", "radius"], EXAMPLE)?;
    let center = table.need("center", EXAMPLE)?.vector()?;
    Ok(Shape::Sphere(Sphere { center, radius: table.need("radius", EXAMPLE)?.positive()? }))
}

fn plane(item: &Item) -> Result<Shape, Problem> {
    const EXAMPLE: &str = "plane = { point = [0, 0, 0], normal = [0, 1, 0] }";
    let table = item.table_such_as(&["point", "normal"], EXAMPLE)?;
    let point = table.need("point", EXAMPLE)?.vector()?;
    Ok(Shape::Plane(Plane { point, normal: table.need("normal", EXAMPLE)?.direction()? }))
}

/// Reads a mesh file, with the materials that it names unless the object has one.
fn mesh(
    item: &Item,
    object: &Table,
    files: &Files,
    warnings: &mut Vec<String>,
) -> Result<Vec<Shape>, Problem> {
    let name = item.text()?;
    let found = files.find(name);
    let format = match &found {
        Ok(file) => Format::of_file(file),
        Err(_) => Format::of(Path::new(name)),
    };
    let format = format.ok_or_else(|| no_mesh(item, name))?;
    let file = found.map_err(|error| Problem::new(item.span.clone(), error.to_string()))?;
    let wrong = |error: ReadMeshError| Problem::new(item.span.clone(), error.to_string());
    let own_materials = object.get("material").is_none();
    // Instances of instances would be as many lists as there are instances.
    let as_one = object.get(instances::KEY).is_some();
    let one = |mesh| vec![Shape::Mesh(mesh)];
    let read = if format == Format::Gltf && !as_one {
        format.read_shapes(&file)
    } else if own_materials {
        format.read_with_materials(&file).map(|(mesh, missing)| (one(mesh), missing))
    } else {
        format.read(&file).map(|mesh| (one(mesh), Vec::new()))
    };
    let (shapes, missing) = read.map_err(wrong)?;
    if own_materials {
        warnings.extend(missing.iter().map(ToString::to_string));
    }
    Ok(shapes::with_meshes(shapes, |mesh| {
        let mesh = if own_materials { mesh } else { bare(mesh) };
        smooth::with_normals(mesh, smooth::CREASE)
    }))
}

/// The problem of a name that is not that of a mesh file.
fn no_mesh(item: &Item, name: &str) -> Problem {
    if let Some((file, _)) = name.split_once('#')
        && Format::of(Path::new(file)) == Some(Format::Gltf)
    {
        let problem = format!("is {}, and a camera (#NAME) cannot be named here", quoted(name));
        return item.problem(problem).help(format!(
            "name {} alone, and state the camera in [camera], as `bothways scenes FILE#NAME` prints it",
            quoted(file)
        ));
    }
    let problem = format!("is {}, which is no mesh file ({EXTENSIONS})", quoted(name));
    item.problem(problem).help("convert it to one of these; no others are read")
}

/// The mesh without materials and colours.
fn bare(mesh: Mesh) -> Mesh {
    let mesh = mesh.with_materials(MeshMaterials::default());
    mesh.with_colors(Vec::new()).expect("no colours fit every mesh")
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
