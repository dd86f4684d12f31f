//! The surfaces of a scene as other programs know them: spheres where they have some, and triangles of one material.

use super::error::ExportError;
use super::instances::{copies, has_some, refused};
use super::target::Target;
use crate::common::glam::{DVec2, DVec3, Vec2, Vec3};
use crate::common::look::texture::plane_axes;
use crate::common::scene::{Attribute, MeshMaterials};
use crate::common::{Instances, Material, Mesh, Object, Plane, Shape, Sphere, Triangle, View};
use crate::formats::generate::Kind;
use crate::wording::{count, readable};
use std::borrow::Cow;
use std::ops::Range;

/// How finely a sphere is divided, around and from pole to pole: its outline is off by a four-thousandth of its radius.
const DIVISIONS: [u32; 2] = [128, 64];
/// How far the square that stands for a plane reaches, in lengths of what the scene has else: seen from within that, its
/// edge is less than a tenth of a thousandth of a radian below the horizon.
const REACH: f64 = 1e4;

/// A surface of one material.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    /// The object, counted from 0.
    pub(super) object: usize,
    pub(super) form: Form<'a>,
    pub(super) material: &'a Material,
    /// Where it is, if it is of instances of a mesh: its form is in coordinates of the mesh.
    pub(super) instances: Option<&'a Instances>,
}

impl Piece<'_> {
    pub(super) fn has_picture(&self) -> bool {
        self.material.texture.is_some()
    }

    /// Whether all corners have texture coordinates.
    pub(super) fn has_coordinates(&self) -> bool {
        match &self.form {
            Form::Triangles(mesh, triangles) => {
                let coordinates = mesh.texture_coordinates();
                triangles.clone().all(|triangle| coordinates.of(triangle).is_some())
            }
            Form::Sphere(_) => true,
        }
    }

    /// Whether the vertices have colours.
    pub(super) fn has_colors(&self) -> bool {
        match &self.form {
            Form::Triangles(mesh, _) => !mesh.colors().is_empty(),
            Form::Sphere(_) => false,
        }
    }
}

#[derive(Debug)]
pub(super) enum Form<'a> {
    Sphere(Sphere),
    /// Some triangles of a mesh.
    Triangles(Cow<'a, Mesh>, Range<usize>),
}

/// All surfaces, in the order of the scene.
#[derive(Debug)]
pub(super) struct Pieces<'a> {
    pub(super) all: Vec<Piece<'a>>,
    /// What is not as in the scene.
    pub(super) notes: Vec<String>,
    /// The middle of what has an end.
    pub(super) middle: DVec3,
}

impl<'a> Pieces<'a> {
    pub(super) fn of(view: &View<'a>, target: Target) -> Pieces<'a> {
        let objects = view.scene.objects();
        let (middle, size) = extent(view, objects);
        let mut pieces = Pieces { all: Vec::new(), notes: Vec::new(), middle };
        for (number, object) in objects.iter().enumerate() {
            pieces.add(number, object, target, view, size);
        }
        pieces.note_what_is_left_out(target);
        pieces
    }

    fn note_what_is_left_out(&mut self, target: Target) {
        let has = |is: fn(&Piece) -> bool| self.all.iter().any(is);
        let mut notes = Vec::new();
        let mut note = |text: &str| notes.push(text.to_owned());
        if target != Target::Obj && has(|piece| piece.material.specular > 0.0) {
            note("highlights are left out: surfaces are diffuse");
        }
        if has(|piece| piece.material.checker.is_some()) {
            note("patterns of two colours are left out: the first one is everywhere");
        }
        if has(|piece| piece.has_picture()) {
            match target {
                Target::Ply => note("pictures on surfaces are left out"),
                Target::Pbrt | Target::Mitsuba | Target::Gltf | Target::Obj => {
                    if has(|piece| piece.has_picture() && !piece.has_coordinates()) {
                        note("pictures are left out where a corner has no texture coordinates");
                    }
                }
            }
        }
        if matches!(target, Target::Obj | Target::Pbrt) && has(|piece| piece.has_colors()) {
            note("colours of vertices are left out");
        }
        if target == Target::Mitsuba && has(|piece| piece.has_picture() && piece.has_colors()) {
            note("colours of vertices are left out where a picture is");
        }
        self.notes.append(&mut notes);
    }

    fn add(&mut self, number: usize, object: &'a Object, target: Target, view: &View, size: f64) {
        if object.shape.primitive_count() == 0 {
            return;
        }
        if let Shape::Instances(instances) = &object.shape
            && has_some(target)
        {
            return self.add_instances(number, object, target, instances);
        }
        let mut push = |form, material| {
            self.all.push(Piece { object: number, form, material, instances: None });
        };
        let whole = |mesh: Mesh| {
            let triangles = 0..mesh.triangles().len();
            Form::Triangles(Cow::Owned(mesh), triangles)
        };
        match &object.shape {
            Shape::Triangle(triangle) => push(whole(of_triangle(*triangle)), &object.material),
            Shape::Mesh(mesh) => {
                for run in runs(object, mesh) {
                    let material = object.material_of(run.start);
                    push(Form::Triangles(Cow::Borrowed(mesh), run), material);
                }
            }
            Shape::Instances(instances) => {
                let meshes = count(instances.placements().len() as u64, "meshes of their own");
                self.notes.push(format!("the instances of object {number} become {meshes}"));
                for instance in 0..instances.placements().len() {
                    let mesh = instances.copied(instance);
                    let runs = runs(object, &mesh);
                    for run in runs {
                        let material = object.material_of(run.start);
                        push(Form::Triangles(Cow::Owned(mesh.clone()), run), material);
                    }
                }
            }
            // Their own texture coordinates begin elsewhere.
            Shape::Sphere(sphere)
                if matches!(target, Target::Pbrt | Target::Mitsuba)
                    && object.material.texture.is_none() =>
            {
                push(Form::Sphere(*sphere), &object.material);
            }
            Shape::Sphere(sphere) => {
                let mesh = of_sphere(*sphere);
                let triangles = count(mesh.triangles().len() as u64, "triangles");
                push(whole(mesh), &object.material);
                self.notes.push(format!("object {number} is a sphere, and becomes {triangles}"));
            }
            Shape::Plane(plane) => {
                let (mesh, side) = of_plane(*plane, view, size);
                push(whole(mesh), &object.material);
                self.notes.push(format!(
                    "object {number} is a plane without an end, and becomes a square of side {}",
                    readable(side)
                ));
            }
        }
    }

    /// Adds the pieces of the mesh, once.
    fn add_instances(
        &mut self,
        number: usize,
        object: &'a Object,
        target: Target,
        instances: &'a Instances,
    ) {
        for run in runs(object, instances.mesh()) {
            let material = object.material_of(run.start);
            let form = Form::Triangles(Cow::Borrowed(instances.mesh()), run);
            self.all.push(Piece { object: number, form, material, instances: Some(instances) });
        }
        let copied = copies(target, instances) as u64;
        if copied > 0 {
            let some = count(copied, &format!("{} instances", refused(target)));
            self.notes.push(format!(
                "object {number} has {some}, copied since {} cannot place such",
                target.name()
            ));
        }
    }

    /// All triangles in one mesh, with what vertices and corners carry; `material` names the materials of the pieces.
    pub(super) fn merged(
        &self,
        target: Target,
        mut material: impl FnMut(&Piece) -> Option<String>,
    ) -> Result<Mesh, ExportError> {
        let mut merged = Merged::default();
        let mut last: Option<&Mesh> = None;
        for piece in &self.all {
            let Form::Triangles(mesh, triangles) = &piece.form else { continue };
            if let Some(name) = material(piece) {
                merged.materials.use_from(merged.triangles.len(), Some(&name));
            }
            // The pieces of one mesh follow one another and share its vertices.
            if !last.is_some_and(|last| std::ptr::eq(last, &**mesh)) {
                merged.begin(mesh);
            }
            last = Some(mesh);
            merged.add(mesh, triangles.clone());
        }
        let vertices = merged.positions.len();
        if u32::try_from(vertices).is_err() {
            return Err(ExportError::TooMany { target, vertices });
        }
        Ok(merged.mesh())
    }
}

/// The triangles of a mesh in runs of one material.
fn runs(object: &Object, mesh: &Mesh) -> Vec<Range<usize>> {
    let end = mesh.triangles().len();
    let Some(materials) = mesh.materials() else { return std::iter::once(0..end).collect() };
    let mut starts: Vec<usize> = materials.spans().iter().map(|span| span.first).collect();
    if starts.first() != Some(&0) {
        starts.insert(0, 0);
    }
    starts.retain(|start| *start < end);
    let same = |a: usize, b: usize| std::ptr::eq(object.material_of(a), object.material_of(b));
    starts.dedup_by(|later, start| same(*start, *later));
    let ends = starts[1..].iter().copied().chain([end]).collect::<Vec<_>>();
    starts.into_iter().zip(ends).map(|(start, end)| start..end).collect()
}

/// Meshes that are being joined.
#[derive(Default)]
struct Merged {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    /// Of the first vertices, up to the last one that has a colour.
    colors: Vec<Vec3>,
    materials: MeshMaterials,
    /// Where the mesh of the last piece begins in each of the three.
    begins: [usize; 3],
}

impl Merged {
    fn begin(&mut self, mesh: &Mesh) {
        self.begins = [
            self.positions.len(),
            self.normals.values.len(),
            self.texture_coordinates.values.len(),
        ];
        if !mesh.colors().is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
            self.colors.extend_from_slice(mesh.colors());
        }
        self.positions.extend_from_slice(mesh.positions());
        self.normals.values.extend_from_slice(&mesh.normals().values);
        self.texture_coordinates.values.extend_from_slice(&mesh.texture_coordinates().values);
    }

    fn add(&mut self, mesh: &Mesh, triangles: Range<usize>) {
        let [position, normal, texture] = self.begins;
        for triangle in triangles {
            self.triangles.push(moved(mesh.triangles()[triangle], position));
            self.normals.corners.push(corners(mesh.normals(), triangle, normal));
            let coordinates = mesh.texture_coordinates();
            self.texture_coordinates.corners.push(corners(coordinates, triangle, texture));
        }
    }

    fn mesh(mut self) -> Mesh {
        if !self.colors.is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
        }
        Mesh::new(self.positions, self.triangles)
            .and_then(|mesh| mesh.with_normals(self.normals))
            .and_then(|mesh| mesh.with_texture_coordinates(self.texture_coordinates))
            .and_then(|mesh| mesh.with_colors(self.colors))
            .expect("they were in meshes")
            .with_materials(self.materials)
    }
}

/// The indices of a triangle's corners, behind so many other values.
#[expect(clippy::cast_possible_truncation, reason = "more are refused before anything is written")]
fn moved(corners: [u32; 3], by: usize) -> [u32; 3] {
    corners.map(|corner| match corner {
        Attribute::<Vec3>::NONE => corner,
        corner => corner.wrapping_add(by as u32),
    })
}

fn corners<T: Copy>(attribute: &Attribute<T>, triangle: usize, by: usize) -> [u32; 3] {
    let none = [Attribute::<T>::NONE; 3];
    attribute.corners.get(triangle).map_or(none, |corners| moved(*corners, by))
}

fn of_triangle(Triangle { a, b, c }: Triangle) -> Mesh {
    let mesh = Mesh::new(vec![a, b, c], vec![[0, 1, 2]]).expect("a scene has finite corners");
    with_coordinates(mesh, vec![Vec2::ZERO, Vec2::X, Vec2::Y])
}

/// The same with a texture coordinate at each vertex.
fn with_coordinates(mesh: Mesh, values: Vec<Vec2>) -> Mesh {
    let corners = mesh.triangles().to_vec();
    mesh.with_texture_coordinates(Attribute { values, corners }).expect("there is one for each")
}

/// A sphere of triangles whose vertices lie on it, with its normals and texture coordinates.
fn of_sphere(Sphere { center, radius }: Sphere) -> Mesh {
    let unit = Kind::Sphere.mesh(DIVISIONS).expect("they are few");
    let positions = unit.positions().iter().map(|&at| center + radius * at).collect();
    let mesh = Mesh::new(positions, unit.triangles().to_vec()).expect("a scene's spheres end");
    mesh.with_normals(unit.normals().clone())
        .and_then(|mesh| mesh.with_texture_coordinates(unit.texture_coordinates().clone()))
        .expect("they are those of the unit sphere")
}

/// A square about the point of a plane that is nearest to the eye, facing as the plane does; and its side.
fn of_plane(Plane { point, normal }: Plane, view: &View, size: f64) -> (Mesh, f32) {
    let eye = view.camera.eye().as_dvec3();
    let normal = normal.as_dvec3().normalize();
    let height = normal.dot(eye - point.as_dvec3());
    let foot = eye - height * normal;
    let side = (REACH * size.max(height.abs())).min(f64::from(f32::MAX) / 4.0);
    let [right, up] = plane_axes(normal).map(|axis| axis * (side / 2.0));
    let corners = [foot - right - up, foot + right - up, foot + right + up, foot - right + up];
    let positions = corners.map(|corner| corner.as_vec3()).to_vec();
    let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]).expect("it was made to end");
    let axes = plane_axes(normal);
    let coordinate = |corner: DVec3| {
        let offset = corner - point.as_dvec3();
        DVec2::from(axes.map(|axis| axis.dot(offset))).as_vec2()
    };
    let mesh = with_coordinates(mesh, corners.map(coordinate).to_vec());
    #[expect(clippy::cast_possible_truncation, reason = "a number to read")]
    let side = side as f32;
    (mesh, side)
}

/// The corners of the box around the mesh, where each instance puts them: no vertex is beyond them.
pub(super) fn box_corners(instances: &Instances) -> impl Iterator<Item = Vec3> {
    let bounds = instances.mesh().bounds();
    instances.placements().iter().flat_map(move |placement| {
        (0..8).filter_map(move |corner| {
            let ends = bounds?;
            let at = [0, 1, 2].map(|axis| ends[corner >> axis & 1][axis]);
            Some(placement.position(at.into()))
        })
    })
}

/// The middle of all that has an end, and how far it reaches from the eye at most; at least 1.
fn extent(view: &View, objects: &[Object]) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut hold = |point: DVec3, radius: f64| {
        low = low.min(point - radius);
        high = high.max(point + radius);
    };
    for object in objects {
        match &object.shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                [a, b, c].into_iter().for_each(|corner| hold(corner.as_dvec3(), 0.0));
            }
            Shape::Mesh(mesh) => {
                mesh.positions().iter().for_each(|position| hold(position.as_dvec3(), 0.0));
            }
            Shape::Sphere(Sphere { center, radius }) => {
                hold(center.as_dvec3(), f64::from(*radius));
            }
            Shape::Instances(instances) => {
                box_corners(instances).for_each(|corner| hold(corner.as_dvec3(), 0.0));
            }
            Shape::Plane(_) => {}
        }
    }
    let eye = view.camera.eye().as_dvec3();
    if low.x > high.x {
        return (eye - view.camera.w(), 1.0);
    }
    let middle = (low + high) / 2.0;
    (middle, ((high - low).length() / 2.0 + (middle - eye).length()).max(1.0))
}
