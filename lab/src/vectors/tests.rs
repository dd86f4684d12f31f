//! Tests of the set as a whole.

use super::*;
use crate::common::{Sign, View};
use std::collections::BTreeSet;

/// The expected picture: one letter per triangle, a dot for nothing.
fn drawn(name: &str) -> Vec<String> {
    let all = all();
    let vector = all.iter().find(|vector| vector.name == name).unwrap();
    let frame = expected(vector).unwrap();
    let letter = |id: u64| char::from(b'a' + u8::try_from(id).unwrap());
    let pixel = |row, column| frame.id(row, column).map_or('.', letter);
    (0..frame.height())
        .map(|row| (0..frame.width()).map(|column| pixel(row, column)).collect())
        .collect()
}

#[test]
fn names_are_file_names_and_points_are_sentences() {
    let all = all();
    let names: BTreeSet<_> = all.iter().map(|vector| vector.name).collect();
    assert_eq!(names.len(), all.len());
    for Vector { name, point, camera, mesh, .. } in &all {
        assert!(name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-'), "{name}");
        assert!(point.ends_with('.') && point.len() <= 90, "{name}");
        assert!(camera.image.iter().all(|side| (8..=24).contains(side)), "{name}");
        assert!(!mesh.triangles().is_empty(), "{name}");
    }
    let groups: Vec<_> = all.iter().map(|vector| vector.group).collect();
    let order = |group| Group::ALL.iter().position(|&other| other == group);
    assert!(groups.iter().map(|&group| order(group)).is_sorted());
}

/// The number of pairs of a triangle and a sample where the sample lies exactly on an edge or a corner.
fn ties(vector: &Vector) -> usize {
    let (scene, camera) = (vector.scene(), vector.camera());
    let (view, grid) = (View::new(&scene, &camera), camera.sample_grid(1));
    let samples = (0..grid.height()).flat_map(|row| (0..grid.width()).map(move |j| (row, j)));
    let on_an_edge = |(row, column)| {
        let signs = view.primitives().filter_map(|(_, primitive)| {
            view.judge().coverage(&primitive, &grid.ray(row, column)).edges
        });
        let tie = |signs: &[Sign; 3], facing: Sign| {
            signs.contains(&Sign::Zero) && !signs.contains(&-facing)
        };
        signs.filter(|edges| tie(&edges.at_sample, edges.facing)).count()
    };
    samples.map(on_an_edge).sum()
}

#[test]
fn scenes_about_edges_have_samples_on_edges() {
    for vector in all() {
        let about = matches!(vector.group, Group::Edges | Group::Corners | Group::SharedEdges);
        let without = ["one-triangle", "one-sample", "no-sample", "strip"].contains(&vector.name);
        if about {
            assert_eq!(ties(&vector) == 0, without, "{}", vector.name);
        }
    }
}

#[test]
fn every_scene_has_an_answer() {
    for vector in all() {
        expected(&vector).unwrap();
    }
}

#[test]
fn what_is_drawn_in_pixels_has_raster_coordinates() {
    for vector in all() {
        let (scene, camera) = (vector.scene(), vector.camera());
        let has = raster::triangles(&View::new(&scene, &camera)).is_some();
        let in_pixels = match vector.group {
            Group::Behind => false,
            Group::Parallel => !matches!(vector.name, "parallel-behind"),
            Group::Camera => false,
            _ => true,
        };
        assert_eq!(has, in_pixels, "{}", vector.name);
    }
}

#[test]
fn a_square_on_samples_owns_its_left_and_top() {
    let square = [
        "........", ".aaaaa..", ".baaaa..", ".bbaaa..", ".bbbaa..", ".bbbba..", "........",
        "........",
    ];
    assert_eq!(drawn("square"), square);
    assert_eq!(drawn("parallel-square"), square);
}

#[test]
fn a_picture_does_not_depend_on_the_size_of_the_world() {
    assert_eq!(drawn("huge-world"), drawn("shared-diagonal"));
    assert_eq!(drawn("tiny-world"), drawn("shared-diagonal"));
}

#[test]
fn orders_that_disagree_are_named() {
    let vector = &all()[0];
    let answer = expected(vector).unwrap();
    let mut other = answer.clone();
    other.set(0, 0, 0, 1.0);
    let error = agree(vector.name, Method::Fast, &answer, &other).unwrap_err().to_string();
    let says = "the scene \"one-triangle\": fast object order and image order differ: the orders \
                see different primitives in 1 pixel, first at (0, 0)";
    assert!(error.starts_with(says), "{error}");
}
