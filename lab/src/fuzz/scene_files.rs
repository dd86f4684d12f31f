//! A case as a scene file, which `bothways` draws again bit for bit.

use super::case::Case;
use super::check::{Disagreement, Witness};
use super::summary::Finding;
use crate::common::glam::Vec3;
use crate::common::{Crop, Instances, Placement, Plane, Shape, Sphere, Triangle};
use crate::formats::{ply, scene_file::framed_mesh_toml};
use crate::orders::Method;
use std::fmt::Write;

/// The samples that the suggested command lets the textbook answer, at most.
const VERIFIED: u64 = 10_000;

/// The files of a finding: each mesh as a PLY file, and last the scene file, which begins with a comment about the
/// disagreement. Each file has its name, which begins with `stem` (letters, digits and hyphens), and its content.
///
/// Numbers read back bit for bit. What a scene file does not say, samples and crop, is in [`command`].
pub fn scene_files(finding: &Finding, stem: &str) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    let toml = format!("{stem}.toml");
    let mut text = String::new();
    for line in [finding.about(), format!("See it with: {}", command(finding, &toml))] {
        // A panic's message may hold any characters.
        let lines = line.lines().map(|line| line.replace(char::is_control, " "));
        text.extend(lines.map(|line| format!("# {}\n", line.trim_start())));
    }
    text.push('\n');
    text += &camera(&finding.case);
    for (number, shape) in finding.case.shapes.iter().enumerate() {
        let object = match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                let [a, b, c] = [a, b, c].map(numbers);
                format!("triangle = {{ a = {a}, b = {b}, c = {c} }}")
            }
            Shape::Sphere(Sphere { center, radius }) => {
                format!("sphere = {{ center = {}, radius = {radius:?} }}", numbers(center))
            }
            Shape::Plane(Plane { point, normal }) => {
                format!("plane = {{ point = {}, normal = {} }}", numbers(point), numbers(normal))
            }
            Shape::Mesh(_) | Shape::Instances(_) => {
                let (mesh, instances) = match shape {
                    Shape::Instances(instances) => (instances.mesh(), rows(instances)),
                    Shape::Mesh(mesh) => (mesh, String::new()),
                    _ => unreachable!("it is one of these"),
                };
                let name = format!("{stem}-{number}.ply");
                let object = format!("mesh = \"{name}\"{instances}");
                let mut file = Vec::new();
                ply::write(mesh, &mut file).expect("memory has room");
                files.push((name, file));
                object
            }
        };
        write!(text, "\n[[object]]\n{object}\n").expect("a string has room");
    }
    files.push((toml, text.into_bytes()));
    files
}

/// The places of instances, behind their mesh.
fn rows(instances: &Instances) -> String {
    let numbers = |placement: &Placement| {
        let numbers = placement.rows().as_flattened().iter().map(|number| format!("{number:?}"));
        format!("[{}]", numbers.collect::<Vec<_>>().join(", "))
    };
    let rows: Vec<String> = instances.placements().iter().map(numbers).collect();
    format!("\ninstances = [{}]", rows.join(", "))
}

/// The command that shows the disagreement again, for the finding's scene file at a path, which is written as it is given: in
/// quotes, if a shell needs them.
pub fn command(finding: &Finding, path: &str) -> String {
    let Case { samples, crop, .. } = finding.case;
    let mut command = format!("bothways {path}");
    if samples != 1 {
        write!(command, " --samples {samples}").expect("a string has room");
    }
    if let Some(Crop { row, column, height, width }) = crop {
        write!(command, " --crop {row},{column},{height},{width}").expect("a string has room");
    }
    let by_textbook = |renderer: &Witness| renderer.method == Method::Textbook;
    match &finding.disagreement {
        Disagreement::Panic { renderer, .. } if by_textbook(renderer) => {
            command += " --method textbook";
        }
        Disagreement::Ids { renderers, .. } if renderers.iter().all(by_textbook) => {
            command += " --method textbook";
        }
        Disagreement::Ids { renderers, .. } if renderers.iter().any(by_textbook) => {
            let pixels = finding.case.pixels();
            let all = u64::from(pixels.height * samples) * u64::from(pixels.width * samples);
            write!(command, " --verify {}", all.min(VERIFIED)).expect("a string has room");
        }
        Disagreement::Panic { .. } | Disagreement::Ids { .. } => {}
    }
    command
}

/// The `[camera]` table: that of a scene with one mesh, without the mesh. A camera's viewport is left out where it follows
/// from the image, and then reads back as the same.
fn camera(case: &Case) -> String {
    let file = framed_mesh_toml(&case.camera, false, "");
    let (camera, _) = file.split_once("\n[[object]]\n").expect("it has one object");
    camera.to_owned()
}

fn numbers(vector: &Vec3) -> String {
    format!("{:?}", vector.to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::{Size, generate};
    use crate::orders::Order;
    use crate::scenes;
    use std::fs;

    fn finding(case: Case) -> Finding {
        let witness = |order, method| Witness { order, method, counted: false };
        let renderers =
            [witness(Order::Image, Method::Fast), witness(Order::Object, Method::Textbook)];
        let disagreement = Disagreement::Ids { renderers, pixel: [1, 2], ids: [None, Some(3)] };
        let size = Size::of(&case);
        Finding { seed: 7, scene: 8, original: size, shrunk: size, steps: 9, disagreement, case }
    }

    #[test]
    fn random_scenes_read_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        for scene in 0..60 {
            let case = generate(11, scene);
            for (name, content) in scene_files(&finding(case.clone()), "found") {
                fs::write(folder.path().join(name), content).unwrap();
            }
            let path = folder.path().join("found.toml");
            let read = scenes::load(path.to_str().unwrap()).unwrap();
            let (written, _) = case.accepted().unwrap();
            assert_eq!(read.camera, case.camera, "scene {scene}");
            assert_eq!(read.scene.primitive_count(), written.primitive_count());
            for id in 0..written.primitive_count() {
                assert_eq!(bits(&read.scene, id), bits(&written, id), "scene {scene}, {id}");
            }
        }
    }

    /// The bits of a primitive's numbers.
    fn bits(scene: &crate::common::Scene, id: u64) -> Vec<u32> {
        let (object, _) = scene.locate(id);
        let vectors = match (scene.triangle(id), &scene.objects()[object].shape) {
            (Some(corners), _) => corners.to_vec(),
            (None, Shape::Sphere(Sphere { center, radius })) => {
                vec![*center, Vec3::splat(*radius)]
            }
            (None, Shape::Plane(Plane { point, normal })) => vec![*point, *normal],
            (None, _) => unreachable!("triangles have corners"),
        };
        vectors.iter().flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
    }

    #[test]
    fn the_command_says_what_the_file_does_not() {
        let crop = Some(Crop { row: 1, column: 2, height: 3, width: 4 });
        let case = Case { samples: 2, crop, ..generate(0, 0) };
        let mut finding = finding(case);
        let command_of = |finding: &Finding| command(finding, "a.toml");
        let drawn = "bothways a.toml --samples 2 --crop 1,2,3,4";
        assert_eq!(command_of(&finding), format!("{drawn} --verify 48"));
        let renderer = Witness { order: Order::Image, method: Method::Fast, counted: false };
        finding.disagreement = Disagreement::Panic { renderer, message: "no".into() };
        assert_eq!(command_of(&finding), drawn);
    }
}
