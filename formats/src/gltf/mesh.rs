//! The triangles of a scene: the primitives of each node's mesh, where the node puts them.

use super::accessor::{Elements, Role};
use super::buffers::Buffers;
use super::error::GltfFault;
use super::item::{Located, item};
use super::nodes::Placed;
use super::texture::{Coordinates, Textures};
use super::undrawn::Undrawn;
use crate::attributes::{self, NONE, push_color};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Root, material};
use bothways_common::scene::{Attribute, Material, Mesh, MeshMaterials};
use glam::{DMat3, DMat4, Vec2, Vec3};

/// The most triangles, and the most vertices, that are copied into the meshes of a scene: some 5 GB of memory, though the file
/// may be small.
const MOST: u64 = 1 << 26;

/// Reads meshes of a file.
pub(super) struct Meshes<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    pub(super) textures: Textures<'a>,
    pub(super) undrawn: Undrawn,
    /// The name of each material of the file.
    names: Vec<String>,
    /// What the meshes that were read have together.
    triangles: u64,
    vertices: u64,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(
        root: &'a Root,
        buffers: &'a Buffers<'a>,
        textures: Textures<'a>,
        undrawn: Undrawn,
    ) -> Self {
        Meshes { root, buffers, textures, undrawn, names: names(root), triangles: 0, vertices: 0 }
    }

    /// Adds the mesh that a node names, where the map puts it.
    pub(super) fn add(
        &mut self,
        builder: &mut Builder,
        place: &Placed,
        world_from_mesh: &DMat4,
    ) -> Result<(), Located> {
        let Some(index) = place.node.mesh else { return Ok(()) };
        let (number, mesh) =
            item(&self.root.meshes, index, "mesh").map_err(|fault| place.located(fault))?;
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            let read = part(self.root, self.buffers, primitive);
            let part = read.map_err(|(place, fault)| {
                let primitive = format!("mesh {number}, primitive {k}");
                (if place.is_empty() { primitive } else { format!("{primitive}, {place}") }, fault)
            })?;
            let Some(part) = part else { continue };
            let added = self.count(&part).and_then(|()| {
                self.use_material(builder, primitive, &part)?;
                builder.add(part, world_from_mesh)
            });
            added.map_err(|fault| place.located(fault))?;
        }
        Ok(())
    }

    /// Makes sure that there is room for one more primitive.
    fn count(&mut self, part: &MeshPart) -> Result<(), GltfFault> {
        self.triangles += part.triangles.len() as u64;
        self.vertices += part.positions.len() as u64;
        let counts = [("triangles", self.triangles), ("vertices", self.vertices)];
        match counts.into_iter().find(|&(_, count)| count > MOST) {
            Some((what, count)) => Err(too_many(what, count)),
            None => Ok(()),
        }
    }

    /// Uses the material of a primitive from the next triangle on.
    fn use_material(
        &mut self,
        builder: &mut Builder,
        primitive: &Primitive,
        part: &MeshPart,
    ) -> Result<(), GltfFault> {
        let first = builder.triangles.len();
        let Some(index) = primitive.material else {
            builder.materials.use_from(first, None);
            return Ok(());
        };
        let (number, material) = item(&self.root.materials, index, "material")?;
        let name = &self.names[number];
        builder.materials.use_from(first, Some(name));
        let (_, info) = base_of(material);
        let texture = info.map_or(Ok(None), |info| self.textures.of(info))?;
        self.undrawn.note_material(material);
        if texture.is_some() && part.texture_coordinates.is_none() {
            self.undrawn.note_lacking(Coordinates::of(info).set);
        }
        builder.materials.define(name, Material { texture, ..material_of(material)? });
        Ok(())
    }
}

/// A primitive in the coordinates of its node.
struct MeshPart {
    positions: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    texture_coordinates: Option<Vec<[f32; 2]>>,
    colors: Option<Vec<[f32; 3]>>,
    triangles: Vec<[u32; 3]>,
}

/// Reads a primitive; `None` if it has no triangles.
fn part(
    root: &Root,
    buffers: &Buffers,
    primitive: &Primitive,
) -> Result<Option<MeshPart>, Located> {
    let own = |fault| (String::new(), fault);
    let Checked::Valid(mode) = primitive.mode else {
        return Err(own(GltfFault::Invalid { what: "its mode" }));
    };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(None);
    }
    let attribute = |semantic, role| {
        let accessor = primitive.attributes.get(&Checked::Valid(semantic));
        accessor.map(|&index| Elements::new(root, buffers, index, role)).transpose()
    };
    let positions = attribute(Semantic::Positions, Role::Positions)?;
    let positions = positions.ok_or_else(|| own(GltfFault::NoPositions))?;
    let count = positions.count;
    let same_count = |attribute: &'static str, elements: &Option<Elements>| match elements {
        Some(elements) if elements.count != count => {
            let [count, positions] = [elements.count, count].map(|count| count as u64);
            Err(own(GltfFault::AttributeCount { attribute, count, positions }))
        }
        _ => Ok(()),
    };
    let normals = attribute(Semantic::Normals, Role::Normals)?;
    same_count("NORMAL", &normals)?;
    let of_texture = Coordinates::of(base_color_texture(root, primitive));
    let set = Semantic::TexCoords(of_texture.set);
    let texture_coordinates = attribute(set, Role::TextureCoordinates)?;
    same_count("TEXCOORD", &texture_coordinates)?;
    let colors = attribute(Semantic::Colors(0), Role::Colors)?;
    same_count("COLOR_0", &colors)?;
    let triangles = triangles_of(root, buffers, primitive, mode, count)?;
    Ok(Some(MeshPart {
        positions: positions.vectors(),
        normals: normals.map(|normals| normals.vectors()),
        texture_coordinates: texture_coordinates
            .map(|values| of_texture.mapped(values.vectors()))
            .transpose()
            .map_err(own)?,
        colors: colors.map(|values| values.vectors()),
        triangles,
    }))
}

/// The triangles of a primitive of so many vertices.
fn triangles_of(
    root: &Root,
    buffers: &Buffers,
    primitive: &Primitive,
    mode: Mode,
    count: usize,
) -> Result<Vec<[u32; 3]>, Located> {
    let own = |fault| (String::new(), fault);
    let Some(index) = primitive.indices else {
        let count = u32::try_from(count).map_err(|_| own(too_many("vertices", count as u64)))?;
        #[expect(clippy::cast_possible_truncation, reason = "less than the count")]
        return triangles(mode, count as usize, |k| k as u32).map_err(own);
    };
    let elements = Elements::new(root, buffers, index, Role::Indices)?;
    let (indices, restart) = (elements.indices(), elements.restart());
    let names_none = |&(_, &index): &(usize, &u32)| index as usize >= count || index == restart;
    match indices.iter().enumerate().find(names_none) {
        Some((place, &index)) if index == restart => {
            Err(own(GltfFault::RestartIndex { place, index }))
        }
        Some((place, &index)) => Err(own(GltfFault::UnknownVertex { place, index, count })),
        None => triangles(mode, indices.len(), |k| indices[k]).map_err(own),
    }
}

/// The texture of a primitive's base colour.
fn base_color_texture<'r>(root: &'r Root, primitive: &Primitive) -> Option<&'r Info> {
    let material = root.materials.get(primitive.material?.value())?;
    base_of(material).1
}

/// The factor and the texture of a material's base colour: those of the model that it states, or of specular and glossiness, which
/// goes before (Khronos, "`KHR_materials_pbrSpecularGlossiness`", 2017), if it states both.
fn base_of(material: &material::Material) -> ([f32; 4], Option<&Info>) {
    let extensions = material.extensions.as_ref();
    match extensions.and_then(|all| all.pbr_specular_glossiness.as_ref()) {
        Some(stated) => (stated.diffuse_factor.0, stated.diffuse_texture.as_ref()),
        None => {
            let stated = &material.pbr_metallic_roughness;
            (stated.base_color_factor.0, stated.base_color_texture.as_ref())
        }
    }
}

/// The triangles of so many corners, as the specification orders them in 3.7.2.1.
fn triangles(
    mode: Mode,
    count: usize,
    corner: impl Fn(usize) -> u32,
) -> Result<Vec<[u32; 3]>, GltfFault> {
    let of = |corners: [usize; 3]| corners.map(&corner);
    match mode {
        Mode::Triangles if count.is_multiple_of(3) => {
            Ok((0..count / 3).map(|k| of([3 * k, 3 * k + 1, 3 * k + 2])).collect())
        }
        Mode::Triangles => {
            Err(GltfFault::CornerCount { count, mode: "triangles", need: "a multiple of 3" })
        }
        _ if count < 3 => Err(GltfFault::CornerCount { count, mode: "strips and fans", need: "3" }),
        Mode::TriangleStrip => {
            let strip = |k| of([k, k + (1 + k % 2), k + (2 - k % 2)]);
            Ok((0..count - 2).map(strip).collect())
        }
        _ => Ok((0..count - 2).map(|k| of([k + 1, k + 2, 0])).collect()),
    }
}

fn too_many(what: &'static str, count: u64) -> GltfFault {
    GltfFault::TooMany { count, what, most: MOST }
}

/// A mesh under construction.
#[derive(Default)]
pub(super) struct Builder {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    colors: Vec<Vec3>,
    materials: MeshMaterials,
}

impl Builder {
    pub(super) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Adds a primitive where the map puts it.
    fn add(&mut self, part: MeshPart, world_from_mesh: &DMat4) -> Result<(), GltfFault> {
        let first = self.positions.len();
        for (vertex, position) in part.positions.iter().enumerate() {
            let position = Vec3::from_array(*position).as_dvec3();
            let position = world_from_mesh.transform_point3(position).as_vec3();
            if !position.is_finite() {
                return Err(GltfFault::OutOfRange { vertex });
            }
            self.positions.push(position);
        }
        for (vertex, color) in part.colors.into_iter().flatten().enumerate() {
            let color = Vec3::from_array(color).clamp(Vec3::ZERO, Vec3::ONE);
            push_color(&mut self.colors, first + vertex, color);
        }
        let [first, triangles] = [first, self.triangles.len()]
            .map(|count| u32::try_from(count).expect("there are fewer than MOST"));
        // A mirror makes counter-clockwise triangles clockwise. They are turned, so that the outside stays outside.
        let mirrors = world_from_mesh.determinant() < 0.0;
        let turned = |[a, b, c]: [u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
        let added: Vec<[u32; 3]> = part.triangles.into_iter().map(turned).collect();
        if let Some(normals) = part.normals {
            let turn = normal_matrix(world_from_mesh);
            let values = normals.into_iter().map(|normal| {
                (turn * Vec3::from_array(normal).as_dvec3()).normalize_or_zero().as_vec3()
            });
            extend(&mut self.normals, values.collect(), &added, triangles, |normal| {
                *normal != Vec3::ZERO
            });
        }
        if let Some(values) = part.texture_coordinates {
            // The format counts from the upper edge of an image, we from the lower one.
            let values = values.into_iter().map(|[u, v]| Vec2::new(u, 1.0 - v)).collect();
            extend(&mut self.texture_coordinates, values, &added, triangles, |_| true);
        }
        self.triangles.extend(added.iter().map(|corners| corners.map(|corner| first + corner)));
        Ok(())
    }

    pub(super) fn finish(self) -> Mesh {
        attributes::mesh(
            self.positions,
            self.triangles,
            self.normals,
            self.texture_coordinates,
            self.colors,
            self.materials,
        )
    }
}

/// Adds values for the corners of some triangles, behind those of other primitives, which may have none.
fn extend<T: Copy>(
    attribute: &mut Attribute<T>,
    values: Vec<T>,
    added: &[[u32; 3]],
    triangles: u32,
    is_value: impl Fn(&T) -> bool,
) {
    let first = u32::try_from(attribute.values.len()).expect("there are fewer than MOST");
    let index =
        |corner: u32| if is_value(&values[corner as usize]) { first + corner } else { NONE };
    attribute.corners.resize(triangles as usize, [NONE; 3]);
    attribute.corners.extend(added.iter().map(|corners| corners.map(index)));
    attribute.values.extend_from_slice(&values);
}

/// The matrix that turns normals: of the cofactors, which is the inverse transpose times the determinant. It exists for
/// every matrix. Its sign keeps normals outside.
fn normal_matrix(world_from_node: &DMat4) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_mat4(*world_from_node);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if world_from_node.determinant() < 0.0 { -cofactors } else { cofactors }
}

/// A name for each material: its own if no other has it.
fn names(root: &Root) -> Vec<String> {
    let mut counts = std::collections::BTreeMap::new();
    let stated = || root.materials.iter().map(|material| material.name.clone().unwrap_or_default());
    for name in stated() {
        *counts.entry(name).or_insert(0) += 1;
    }
    let unique = |(number, name): (usize, String)| match counts.get(&name) {
        Some(1) if !name.is_empty() => name,
        _ => format!("{name}#{number}"),
    };
    stated().enumerate().map(unique).collect()
}

/// A material in its base colour, which the format states in linear light.
fn material_of(material: &material::Material) -> Result<Material, GltfFault> {
    let ([red, green, blue, _], _) = base_of(material);
    let color = Vec3::new(red, green, blue);
    if color.to_array().iter().all(|component| (0.0..=1.0).contains(component)) {
        Ok(Material { color, ..Material::default() })
    } else {
        Err(GltfFault::Color)
    }
}
