//! Streams meshes that are larger than memory: a file is read in passes, never as a whole.
//!
//! Vertices stay in memory, 12 bytes each, because any face may name any of them. Faces are read again in every pass.
//! The facets of an STL file name no vertices: there a table of their places stays in memory as well, 20 to 40 bytes each.
//! A polygon that is not a triangle is in memory while it is cut, which takes a look at its positions in every pass.
//! Only positions are read, without normals, texture coordinates and materials: few triangles of so large a mesh
//! would show them.

use crate::mesh_file::{Format, ReadMeshError};
use crate::obj::ObjFile;
use crate::ply::PlyFile;
use crate::stl::StlFile;
use crate::warning::MaterialWarning;
use bothways_common::scene::Positions;
use glam::Vec3;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// An open mesh file. Only its vertices are in memory.
///
/// ```
/// use bothways_formats::mesh_file::Format;
/// use bothways_formats::mesh_stream::MeshStream;
///
/// # let name = format!("bothways-mesh-stream-{}.obj", std::process::id());
/// # let path = std::env::temp_dir().join(name);
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
///
/// let mut stream = MeshStream::open(&path, Format::Obj)?;
/// let mut highest = f32::NEG_INFINITY;
/// let triangles = stream.for_each_triangle(|positions, vertices| {
///     for vertex in vertices {
///         highest = highest.max(positions.get(vertex).y);
///     }
/// })?;
/// assert_eq!((triangles, highest), (1, 1.0));
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct MeshStream {
    name: String,
    positions: Positions,
    faces: Faces,
    triangles: Option<u32>,
}

#[derive(Debug)]
enum Faces {
    Obj(Box<ObjFile>),
    Ply(Box<PlyFile<BufReader<File>>>),
    Stl(Box<StlFile<BufReader<File>>>),
}

/// Why a mesh cannot be streamed.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// The file cannot be read, or is wrong.
    #[error(transparent)]
    Mesh(#[from] ReadMeshError),
    /// The mesh has more triangles than there are ids.
    #[error("{file}: more than {} triangles, which is as many as can be told apart", u32::MAX - 1)]
    TooManyTriangles {
        /// The file.
        file: String,
    },
}

impl MeshStream {
    /// Opens a mesh file and reads its vertices.
    ///
    /// # Errors
    ///
    /// The file cannot be read more than once, as a pipe cannot, or is wrong before the end of its last vertex; or the format
    /// cannot be [streamed](Format::can_be_streamed).
    pub fn open(path: &Path, format: Format) -> Result<MeshStream, ReadMeshError> {
        let mut positions = Positions::default();
        let faces = match format {
            Format::Obj => {
                let mut file = Box::new(ObjFile::open(path)?);
                file.vertices(|position| positions.push(position))?;
                Faces::Obj(file)
            }
            Format::Ply => {
                let mut file = Box::new(PlyFile::open(path)?);
                file.vertices(|position| positions.push(position))?;
                Faces::Ply(file)
            }
            Format::Stl => {
                let mut file = Box::new(StlFile::open(path)?);
                file.vertices(|position| positions.push(position))?;
                Faces::Stl(file)
            }
            Format::Gltf => {
                return Err(ReadMeshError::NotStreamed { file: path.display().to_string() });
            }
        };
        Ok(MeshStream { name: path.display().to_string(), positions, faces, triangles: None })
    }

    /// The positions of the vertices.
    pub fn positions(&self) -> &Positions {
        &self.positions
    }

    /// The number of triangles; `None` before the first complete pass over them.
    pub fn triangles(&self) -> Option<u32> {
        self.triangles
    }

    /// A warning if the file names materials: they are not read.
    pub fn material_warning(&self) -> Option<MaterialWarning> {
        match &self.faces {
            Faces::Obj(file) => file.material_warning(),
            Faces::Ply(file) => file.color_warning(),
            Faces::Stl(_) => None,
        }
    }

    /// Reads the faces once, from the first to the last, calls `visit` with the vertices of each triangle, and returns
    /// the number of triangles.
    ///
    /// The number of a triangle in this order, counted from 0, is its id. All vertices that it names exist.
    ///
    /// # Errors
    ///
    /// The file is wrong, or has more triangles than there are ids. The triangles visited before are useless then.
    pub fn for_each_triangle(
        &mut self,
        mut visit: impl FnMut(&Positions, [u32; 3]),
    ) -> Result<u32, StreamError> {
        let (mut count, positions) = (0_u64, &self.positions);
        let visit = |triangle| {
            count += 1;
            if count < u64::from(u32::MAX) {
                visit(positions, triangle);
            }
        };
        match &mut self.faces {
            Faces::Obj(file) => file.triangles(positions, visit).map_err(ReadMeshError::from)?,
            Faces::Ply(file) => file.triangles(positions, visit).map_err(ReadMeshError::from)?,
            Faces::Stl(file) => file.triangles(visit).map_err(ReadMeshError::from)?,
        }
        match u32::try_from(count) {
            Ok(count) if count < u32::MAX => {
                self.triangles = Some(count);
                Ok(count)
            }
            _ => Err(StreamError::TooManyTriangles { file: self.name.clone() }),
        }
    }

    /// Returns the number of triangles, and the positions that they use, in the order of the vertices.
    ///
    /// This takes one pass over the faces, and one bit of memory for each vertex.
    ///
    /// # Errors
    ///
    /// As for [`MeshStream::for_each_triangle`].
    pub fn used_positions(
        &mut self,
    ) -> Result<(u32, impl Iterator<Item = Vec3> + Clone + use<'_>), StreamError> {
        let mut used = vec![0_u64; self.positions.len().div_ceil(64)];
        let triangles = self.for_each_triangle(|_, triangle| {
            for vertex in triangle {
                used[vertex as usize / 64] |= 1 << (vertex % 64);
            }
        })?;
        let is_used = move |vertex: usize| used[vertex / 64] >> (vertex % 64) & 1 == 1;
        let all = self.positions.iter().enumerate();
        let used = all.filter(move |(vertex, _)| is_used(*vertex)).map(|(_, position)| position);
        Ok((triangles, used))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{InputFile, Reach};
    use bothways_common::scene::Mesh;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::sample::select;

    /// The mesh of a file as the reader reads it, and as a stream reads it; `None` if the file is refused.
    fn both(name: &str, content: &[u8]) -> [Option<Mesh>; 2] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let format = Format::of(&path).unwrap();
        let whole = format.read(&InputFile::on_disk(&path, Reach::Folder)).ok().map(|whole| {
            Mesh::new(whole.positions().to_vec(), whole.triangles().to_vec()).unwrap()
        });
        let streamed = MeshStream::open(&path, format).ok().and_then(|mut stream| {
            let mut triangles = Vec::new();
            let count = stream.for_each_triangle(|_, triangle| triangles.push(triangle)).ok()?;
            assert_eq!(count as usize, triangles.len());
            Some(Mesh::new(stream.positions().iter().collect(), triangles).unwrap())
        });
        [whole, streamed]
    }

    #[test]
    fn a_stream_shows_what_the_reader_reads() {
        let obj = "\u{feff}f 1 3 2\nv 0 0 0\r\nvt 1\nv 1 0 0\nv 0 1 0 # c\nf -3/1 -2 \\\n-1\n\
                   v 5 5 5\nf 1 2 \\\r\n4 3\nvn 0 0 1\ng x";
        let [whole, streamed] = both("a.obj", obj.as_bytes());
        assert_eq!(whole, streamed);
        assert_eq!(whole.unwrap().triangles(), [[0, 2, 1], [0, 1, 2], [0, 1, 3], [0, 3, 2]]);
    }

    #[test]
    fn a_stream_of_either_stl_shows_what_the_reader_reads() {
        let mesh = crate::generate::Kind::Torus.mesh([9, 7]).unwrap();
        let mut binary = Vec::new();
        crate::stl::write(&mesh, &mut binary).unwrap();
        let mut text = String::from("solid torus\n");
        for triangle in 0..mesh.triangles().len() {
            text += "facet normal 0 0 0\nouter loop\n";
            for corner in mesh.corners(triangle) {
                text += &format!("vertex {:?} {:?} {:?}\n", corner.x, corner.y, corner.z);
            }
            text += "endloop\nendfacet\n";
        }
        text += "endsolid torus\n";
        let [whole, streamed] = both("binary.stl", &binary);
        assert_eq!(whole, streamed);
        assert_eq!(whole.as_ref().unwrap().triangles().len(), 126);
        let of_text = both("text.stl", text.as_bytes());
        assert_eq!(of_text, [whole, streamed]);
        // What is wrong is refused by both.
        for bad in ["", "solid a\nendsolid\n", "solid a\nfacet\n", "no solid"] {
            assert_eq!(both("bad.stl", bad.as_bytes()), [None, None], "{bad}");
        }
        binary[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(both("nan.stl", &binary), [None, None]);
    }

    #[test]
    fn an_stl_file_that_changes_while_it_is_streamed_is_an_error() {
        let path = std::env::temp_dir().join(format!("bothways-turns-{}.stl", std::process::id()));
        let facet = |x: f32| {
            format!(
                "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {x} 0 0\nvertex 0 1 0\n\
                     endloop\nendfacet\nendsolid\n"
            )
        };
        std::fs::write(&path, facet(1.0)).unwrap();
        let mut stream = MeshStream::open(&path, Format::Stl).unwrap();
        assert_eq!(
            stream.for_each_triangle(|_, triangle| assert_eq!(triangle, [0, 1, 2])).unwrap(),
            1
        );
        std::fs::write(&path, facet(2.0)).unwrap();
        let error = stream.for_each_triangle(|_, _| ()).unwrap_err().to_string();
        assert!(error.contains("the file has changed since its vertices were read"), "{error}");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn the_positions_of_lonely_vertices_are_left_out() {
        let path = std::env::temp_dir().join(format!("bothways-used-{}.obj", std::process::id()));
        std::fs::write(&path, "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 0 1 0\nf 5 2 3\n").unwrap();
        let mut stream = MeshStream::open(&path, Format::Obj).unwrap();
        assert_eq!(stream.triangles(), None);
        let (triangles, used) = stream.used_positions().unwrap();
        assert_eq!(triangles, 1);
        assert_eq!(used.collect::<Vec<Vec3>>(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
        assert_eq!(stream.triangles(), Some(1));
        std::fs::remove_file(&path).unwrap();
    }

    /// Pieces of OBJ files, and some that do not occur in them.
    const PIECES: [&str; 24] = [
        "v 1 2 3\n",
        "v 1 0 0\r\n",
        "v 0 1 0 \\\n7\n",
        "v 0 0 2\n",
        "vt 1\n",
        "vn 0 0 1\n",
        "f 1 2 3\n",
        "f 3 2 1 4\n",
        "f -1 -2 -3\n",
        "f 1 2 -1 -2 -3\n",
        "v 2 -1 0\n",
        "f 1/1 2/1 3/1\n",
        "f 1//1 2 \\\r\n 3\n",
        "fo 2 1 3\n",
        "f 1 2 9\n",
        "f -5 1 2\n",
        "g a\n",
        "usemtl a\n",
        "mtllib a.mtl\n",
        "# f \\\n",
        "\n",
        "f",
        " 1",
        "x\n",
    ];

    proptest! {
        #[test]
        fn a_stream_takes_and_refuses_what_the_reader_does(
            pieces in vec(select(PIECES.to_vec()), 0..12),
        ) {
            let text = ["v 0 0 0\nv 1 1 0\n", &pieces.concat()].concat();
            let [whole, streamed] = both("pieces.obj", text.as_bytes());
            prop_assert_eq!(whole, streamed, "{}", text);
        }
    }
}
