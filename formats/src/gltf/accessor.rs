//! Checks accessors, and reads what they describe.
//!
//! The rules are those of the specification, 3.6.2; the page of [`gltf`](crate::gltf) lists them. Nothing is read before all
//! of them hold.

use super::buffers::{Buffers, View};
use super::error::GltfFault;
use super::item::{Located, QUANTIZATION, item};
use ::gltf::json::accessor::sparse::Sparse;
use ::gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Accessor, Index, Root};
use serde_json::Value;

/// What an accessor is for, which decides the types that it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Positions,
    Normals,
    TextureCoordinates,
    /// Of three components; a fourth, the opacity, is not read.
    Colors,
    /// Translations or scales of instances.
    Vectors,
    /// Rotations of instances.
    Quaternions,
    Indices,
}

impl Role {
    fn kind(self) -> (Type, &'static str) {
        match self {
            Role::Positions | Role::Normals | Role::Vectors => (Type::Vec3, "VEC3"),
            Role::Quaternions => (Type::Vec4, "VEC4"),
            Role::TextureCoordinates => (Type::Vec2, "VEC2"),
            Role::Colors => (Type::Vec3, "VEC3 or VEC4"),
            Role::Indices => (Type::Scalar, "SCALAR"),
        }
    }

    /// How many components of an element are read.
    fn read(self) -> usize {
        self.kind().0.multiplicity()
    }

    /// Whether components of this type are allowed, and what is.
    fn allows(
        self,
        component: ComponentType,
        is_normalized: bool,
        quantized: bool,
    ) -> (bool, &'static str) {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        let is_float = component == F32 && !is_normalized;
        match (self, quantized) {
            (Role::Indices, _) => (
                matches!(component, U8 | U16 | U32) && !is_normalized,
                "unsigned bytes, shorts or ints that are not normalized",
            ),
            (Role::TextureCoordinates, false) | (Role::Colors, _) => (
                is_float || matches!(component, U8 | U16) && is_normalized,
                "floats, or normalized unsigned bytes or shorts",
            ),
            (Role::Positions | Role::Normals, false) | (Role::Vectors, _) => (is_float, "floats"),
            (Role::Normals, true) | (Role::Quaternions, _) => (
                is_float || matches!(component, I8 | I16) && is_normalized,
                "floats, or normalized bytes or shorts",
            ),
            (Role::Positions | Role::TextureCoordinates, true) => {
                (is_float || !matches!(component, F32 | U32), "floats, bytes or shorts")
            }
        }
    }
}

/// The elements of an accessor, all of whose places have been checked.
pub(super) struct Elements<'a> {
    pub(super) count: usize,
    component: ComponentType,
    is_normalized: bool,
    /// Without it, all elements are 0 but those that are replaced.
    base: Option<Strided<'a>>,
    /// The elements that are replaced, by rising indices.
    replaced: Vec<u32>,
    replacements: Option<Strided<'a>>,
}

/// Elements in a view.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Elements<'a> {
    /// Checks an accessor.
    pub(super) fn new(
        root: &Root,
        buffers: &'a Buffers,
        index: Index<Accessor>,
        role: Role,
    ) -> Result<Elements<'a>, Located> {
        let (number, accessor) =
            item(&root.accessors, index, "accessor").map_err(|fault| (String::new(), fault))?;
        let located = |fault| (format!("accessor {number}"), fault);
        // A fault of the view is told as that of the view.
        let place = |(place, fault): Located| match place.as_str() {
            "" => located(fault),
            view => (format!("accessor {number}, {view}"), fault),
        };
        let (component, kind) = component_of(root, accessor, role).map_err(located)?;
        check_bounds(accessor, kind).map_err(located)?;
        let count = accessor.count.0;
        if count == 0 {
            return Err(located(GltfFault::NoElements));
        }
        let layout = Layout { role, kind, component, count };
        let base = match accessor.buffer_view {
            Some(view) => {
                let view = buffers.view(root, view).map_err(place)?;
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                Some(layout.within(view, offset).map_err(located)?)
            }
            // So many zeros may take far more memory than the file.
            None if accessor.sparse.is_none() || count > buffers.length() => {
                return Err(located(GltfFault::NoView { count }));
            }
            None => None,
        };
        let (replaced, replacements) = match &accessor.sparse {
            Some(sparse) => {
                let (replaced, values) = layout.sparse(root, buffers, sparse).map_err(place)?;
                (replaced, Some(values))
            }
            None => (Vec::new(), None),
        };
        #[expect(clippy::cast_possible_truncation, reason = "no more than bytes in memory")]
        let count = count as usize;
        let is_normalized = accessor.normalized;
        let elements = Elements { count, component, is_normalized, base, replaced, replacements };
        elements.check_finite(role).map_err(located)?;
        Ok(elements)
    }

    /// The vectors of an accessor.
    pub(super) fn vectors<const N: usize>(&self) -> Vec<[f32; N]> {
        let at = |bytes: &Strided, element: usize| {
            std::array::from_fn(|k| self.float(bytes, element * bytes.stride, k))
        };
        let mut vectors: Vec<[f32; N]> = match &self.base {
            Some(base) => (0..self.count).map(|element| at(base, element)).collect(),
            None => vec![[0.0; N]; self.count],
        };
        if let Some(values) = &self.replacements {
            for (place, &element) in self.replaced.iter().enumerate() {
                vectors[element as usize] = at(values, place);
            }
        }
        vectors
    }

    /// The indices of an accessor.
    pub(super) fn indices(&self) -> Vec<u32> {
        let at = |bytes: &Strided, element: usize| {
            whole(&bytes.bytes[element * bytes.stride..], self.component)
        };
        let mut indices: Vec<u32> = match &self.base {
            Some(base) => (0..self.count).map(|element| at(base, element)).collect(),
            None => vec![0; self.count],
        };
        if let Some(values) = &self.replacements {
            for (place, &element) in self.replaced.iter().enumerate() {
                indices[element as usize] = at(values, place);
            }
        }
        indices
    }

    /// The largest number of the type of the components, which as an index names no vertex: to graphics hardware it means
    /// that a new primitive begins.
    pub(super) fn restart(&self) -> u32 {
        match self.component {
            ComponentType::U8 => u8::MAX.into(),
            ComponentType::U16 => u16::MAX.into(),
            _ => u32::MAX,
        }
    }

    /// Makes sure that no number is NaN or infinite.
    fn check_finite(&self, role: Role) -> Result<(), GltfFault> {
        if self.component != ComponentType::F32 {
            return Ok(());
        }
        let numbers = role.read();
        let replaced = self.replacements.iter().map(|values| (values, self.replaced.len()));
        for (values, count) in self.base.iter().map(|base| (base, self.count)).chain(replaced) {
            let is_finite =
                |k: usize| self.float(values, k / numbers * values.stride, k % numbers).is_finite();
            if let Some(number) = (0..count * numbers).find(|&k| !is_finite(k)) {
                return Err(GltfFault::NotFinite { number });
            }
        }
        Ok(())
    }

    /// Component `k` of the element at a byte. Integers that are normalized stand for fractions, as the specification
    /// says in 3.11.
    fn float(&self, values: &Strided, at: usize, k: usize) -> f32 {
        let bytes = &values.bytes[at + k * self.component.size()..];
        let fraction = |value: f32, one: f32| {
            if self.is_normalized { (value / one).max(-1.0) } else { value }
        };
        match self.component {
            ComponentType::I8 => fraction(f32::from(i8::from_le_bytes([bytes[0]])), 127.0),
            ComponentType::U8 => fraction(f32::from(bytes[0]), 255.0),
            ComponentType::I16 => {
                fraction(f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0)
            }
            ComponentType::U16 => {
                fraction(f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0)
            }
            ComponentType::U32 => unreachable!("only indices are of this type"),
            ComponentType::F32 => f32::from_bits(whole(bytes, ComponentType::U32)),
        }
    }
}

/// The types of an accessor's components and of its elements, if the role allows them.
fn component_of(
    root: &Root,
    accessor: &Accessor,
    role: Role,
) -> Result<(ComponentType, Type), GltfFault> {
    let Checked::Valid(GenericComponentType(component)) = accessor.component_type else {
        return Err(GltfFault::Invalid { what: "its componentType" });
    };
    let Checked::Valid(kind) = accessor.type_ else {
        return Err(GltfFault::Invalid { what: "its type" });
    };
    let (expected, name) = role.kind();
    if kind != expected && (role, kind) != (Role::Colors, Type::Vec4) {
        let found = format!("{kind:?}").to_uppercase();
        return Err(GltfFault::Type { what: "type", expected: name, found });
    }
    let quantized = root.extensions_used.iter().any(|name| name == QUANTIZATION);
    let (is_allowed, expected) = role.allows(component, accessor.normalized, quantized);
    if is_allowed {
        return Ok((component, kind));
    }
    let normalized = if accessor.normalized { ", normalized" } else { "" };
    let found = format!("{}{normalized}", name_of(component));
    Err(GltfFault::Type { what: "components", expected, found })
}

/// Makes sure that bounds, if they are stated, are a number for each component.
///
/// Whether the elements keep to them is not asked. Nothing is drawn differently for them, and there are many files whose bounds
/// are missing, or were rounded when they were written.
fn check_bounds(accessor: &Accessor, kind: Type) -> Result<(), GltfFault> {
    let components = kind.multiplicity();
    let is_well_formed = |bound: &Value| {
        let numbers = bound.as_array().filter(|numbers| numbers.len() == components);
        numbers.is_some_and(|numbers| numbers.iter().all(Value::is_number))
    };
    for (bound, stated) in [("min", &accessor.min), ("max", &accessor.max)] {
        if stated.as_ref().is_some_and(|stated| !is_well_formed(stated)) {
            return Err(GltfFault::Bounds { bound, components });
        }
    }
    Ok(())
}

fn name_of(component: ComponentType) -> &'static str {
    match component {
        ComponentType::I8 => "BYTE",
        ComponentType::U8 => "UNSIGNED_BYTE",
        ComponentType::I16 => "SHORT",
        ComponentType::U16 => "UNSIGNED_SHORT",
        ComponentType::U32 => "UNSIGNED_INT",
        ComponentType::F32 => "FLOAT",
    }
}

/// What the elements of an accessor are.
#[derive(Clone, Copy)]
struct Layout {
    role: Role,
    kind: Type,
    component: ComponentType,
    count: u64,
}

impl Layout {
    fn element_size(self) -> usize {
        self.component.size() * self.kind.multiplicity()
    }

    /// The elements from a byte of a view on.
    fn within(self, view: View<'_>, offset: u64) -> Result<Strided<'_>, GltfFault> {
        let size = self.element_size();
        let is_attribute = self.role != Role::Indices;
        let stride = match view.stride {
            Some(_) if !is_attribute => return Err(GltfFault::StrideNotAllowed),
            Some(stride) if stride < size => {
                return Err(GltfFault::StrideTooShort { stride, size });
            }
            Some(stride) => stride,
            None => size,
        };
        let component = self.component.size() as u64;
        let alignment = if is_attribute { component.max(4) } else { component };
        if !offset.is_multiple_of(alignment) {
            return Err(GltfFault::Unaligned { offset, of: "view", alignment });
        }
        // Without a stride, elements of bytes or shorts would follow one another unaligned.
        if is_attribute && stride % 4 != 0 {
            return Err(GltfFault::UnalignedElements { bytes: stride });
        }
        let in_buffer = view.offset + offset;
        if !in_buffer.is_multiple_of(component) {
            return Err(GltfFault::Unaligned {
                offset: in_buffer,
                of: "buffer",
                alignment: component,
            });
        }
        strided(view.bytes, offset, stride, size, self.count)
    }

    /// The indices of the elements that are replaced, and what replaces them.
    fn sparse<'a>(
        self,
        root: &Root,
        buffers: &'a Buffers,
        sparse: &Sparse,
    ) -> Result<(Vec<u32>, Strided<'a>), Located> {
        let own = |fault| (String::new(), fault);
        let count = sparse.count.0;
        if count == 0 || count > self.count {
            return Err(own(GltfFault::SparseCount { count, of: self.count }));
        }
        let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
            return Err(own(GltfFault::Invalid {
                what: "the componentType of its sparse indices",
            }));
        };
        let packed = |view: View<'a>, offset: u64, component: ComponentType, size: usize| {
            if view.stride.is_some() {
                return Err(own(GltfFault::StrideNotAllowed));
            }
            let alignment = component.size() as u64;
            for (offset, of) in [(offset, "view"), (view.offset + offset, "buffer")] {
                if !offset.is_multiple_of(alignment) {
                    return Err(own(GltfFault::Unaligned { offset, of, alignment }));
                }
            }
            strided(view.bytes, offset, size, size, count).map_err(own)
        };
        let view = buffers.view(root, sparse.indices.buffer_view)?;
        let indices = packed(view, sparse.indices.byte_offset.0, component, component.size())?;
        let mut replaced: Vec<u32> = Vec::new();
        #[expect(clippy::cast_possible_truncation, reason = "no more than bytes in memory")]
        for place in 0..count as usize {
            let index = whole(&indices.bytes[place * indices.stride..], component);
            let before = replaced.last().copied();
            if before.is_some_and(|before| before >= index) || u64::from(index) >= self.count {
                return Err(own(GltfFault::SparseIndices { index, before, count: self.count }));
            }
            replaced.push(index);
        }
        let view = buffers.view(root, sparse.values.buffer_view)?;
        let size = self.element_size();
        let values = packed(view, sparse.values.byte_offset.0, self.component, size)?;
        Ok((replaced, values))
    }
}

/// So many elements from a byte on, all of which are within the bytes.
fn strided(
    bytes: &[u8],
    offset: u64,
    stride: usize,
    size: usize,
    count: u64,
) -> Result<Strided<'_>, GltfFault> {
    let end = u128::from(offset) + stride as u128 * u128::from(count - 1) + size as u128;
    let length = bytes.len() as u64;
    if end > u128::from(length) {
        return Err(GltfFault::AccessorTooLong { count, end, length });
    }
    #[expect(clippy::cast_possible_truncation, reason = "within the bytes")]
    Ok(Strided { bytes: &bytes[offset as usize..], stride })
}

/// An unsigned integer of a type, little-endian.
fn whole(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => bytes[0].into(),
        ComponentType::U16 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}
