//! The hints of `bothways diff`: what a renderer with one mistake is said to do.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use bothways::common::View;
use bothways::diff::foreign::{Buffer, Content, compare};
use bothways::vectors::{Group, Vector, raster};

/// A mistake of a renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    None,
    SamplesInCorners,
    InclusiveEdges,
    CulledClockwise,
    Transposed,
    TurnedUpsideDown,
}

/// Twice the signed area of `a`, `b`, `c`, positive if they are clockwise as seen; exact for the small
/// dyadic numbers of the vectors used here.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether a triangle, clockwise, covers a place.
fn covers([a, b, c]: [[f64; 2]; 3], place: [f64; 2], inclusive: bool) -> bool {
    [(a, b), (b, c), (c, a)].into_iter().all(|(p, q)| {
        let edge = area(p, q, place);
        let (right, down) = (q[0] - p[0], q[1] - p[1]);
        // Clockwise with y down, a left edge goes up and a top edge to the right.
        let owned = down < 0.0 || (down == 0.0 && right > 0.0);
        edge > 0.0 || (edge == 0.0 && (owned || inclusive))
    })
}

/// The ids of a flat scene from a small rasterizer with one mistake. Of several triangles that cover a pixel, the first
/// is seen.
fn drawn(vector: &Vector, mistake: Mistake) -> Buffer<'static> {
    let (scene, camera) = (vector.scene(), vector.camera());
    let triangles = raster::triangles(&View::new(&scene, &camera)).unwrap();
    let [width, height] = camera.image();
    let id = |i: u32, j: u32| {
        let half = if mistake == Mistake::SamplesInCorners { 0.0 } else { 0.5 };
        let place = [f64::from(j) + half, f64::from(i) + half];
        let seen = triangles.iter().position(|corners| {
            let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
            let facing = area(a, b, c);
            let culled = mistake == Mistake::CulledClockwise && facing > 0.0;
            let triangle = if facing > 0.0 { [a, b, c] } else { [a, c, b] };
            facing != 0.0 && !culled && covers(triangle, place, mistake == Mistake::InclusiveEdges)
        });
        seen.map(|id| id as u64)
    };
    let pixels = (0..height).flat_map(|i| (0..width).map(move |j| (i, j)));
    let ids = pixels.map(|(i, j)| match mistake {
        Mistake::Transposed => id(j, i),
        Mistake::TurnedUpsideDown => id(height - 1 - i, j),
        _ => id(i, j),
    });
    Buffer::new([width, height], 1, Content::Ids(ids.collect()))
}

/// The coverage of a buffer of ids.
fn mask_of(buffer: &Buffer) -> Buffer<'static> {
    let Content::Ids(ids) = buffer.content() else { panic!("no ids") };
    let mask: Vec<bool> = ids.iter().map(Option::is_some).collect();
    Buffer::new(buffer.size(), 1, Content::Mask(mask.into()))
}

/// The flat scenes of the set: no depth, and corners with few bits.
fn flat_vectors() -> Vec<Vector> {
    let flat = |vector: &Vector| {
        let groups = [Group::Edges, Group::Corners, Group::SharedEdges];
        groups.contains(&vector.group) || vector.name == "far-off-corners"
    };
    bothways::vectors::all().into_iter().filter(flat).collect()
}

/// The hints of the comparison between a rasterizer with a mistake and one without.
fn hints(name: &str, mistake: Mistake, as_masks: bool) -> Vec<String> {
    let vector = flat_vectors().into_iter().find(|vector| vector.name == name).unwrap();
    let (mut right, mut wrong) = (drawn(&vector, Mistake::None), drawn(&vector, mistake));
    if as_masks {
        (right, wrong) = (mask_of(&right), mask_of(&wrong));
    }
    compare(&wrong, &right).unwrap().hints
}

#[test]
fn the_small_rasterizer_is_right_without_a_mistake() {
    for vector in flat_vectors() {
        let expected = bothways::vectors::expected(&vector).unwrap();
        let ids = expected.ids().iter();
        let expected = Content::Ids(ids.collect());
        assert_eq!(drawn(&vector, Mistake::None).content(), &expected, "{}", vector.name);
    }
}

#[test]
fn hints_name_the_mistake_or_none() {
    // The required hint for each mistake, if there is one.
    let named = [
        (Mistake::SamplesInCorners, ["moved 1 row up and 1 column to the left", "missed between"]),
        (Mistake::InclusiveEdges, ["inclusive edges have no hint of their own"; 2]),
        (Mistake::CulledClockwise, ["culled"; 2]),
        (Mistake::Transposed, ["transposed"; 2]),
        (Mistake::TurnedUpsideDown, ["turned upside down"; 2]),
    ];
    let mut wrongly_named = Vec::new();
    for vector in flat_vectors() {
        let right = drawn(&vector, Mistake::None);
        for (mistake, names) in named {
            if mistake == Mistake::Transposed && right.size()[0] != right.size()[1] {
                continue;
            }
            let wrong = drawn(&vector, mistake);
            for (right, wrong) in [(mask_of(&right), mask_of(&wrong)), (right.clone(), wrong)] {
                let comparison = compare(&right, &wrong).unwrap();
                let says = |hint: &String| names.iter().any(|name| hint.contains(name));
                let named = comparison.hints.iter().any(says);
                if !comparison.equal && !comparison.hints.is_empty() && !named {
                    wrongly_named.push((vector.name, mistake, comparison.hints));
                }
            }
        }
    }
    assert!(wrongly_named.is_empty(), "{wrongly_named:#?}");
}

#[test]
fn misleading_hints_of_earlier_versions_are_gone() {
    // A transposed square picture got the hint that it was turned by 180 degrees.
    let transposed = hints("three-corners", Mistake::Transposed, false);
    assert!(transposed.len() == 1 && transposed[0].contains("transposed"), "{transposed:?}");
    // Samples in corners on `square` got the same hint alone. As a mask it may be right; so are others, which are given, too.
    let half = hints("square", Mistake::SamplesInCorners, true);
    for may_be in ["moved 1 row down and 1 column to the right", "180 degrees", "diagonal"] {
        assert!(half.iter().any(|hint| hint.contains(may_be)), "{half:?}");
    }
    // The ids of the two triangles exclude it.
    let half = hints("square", Mistake::SamplesInCorners, false);
    assert!(half.len() == 2 && half[0].contains("diagonal"), "{half:?}");
    assert!(half[1].contains("moved 1 row down and 1 column to the right"), "{half:?}");
    // Inclusive edges on `tiles` got the hint "moved by 1 rows and 1 columns".
    for as_masks in [true, false] {
        assert_eq!(hints("tiles", Mistake::InclusiveEdges, as_masks), [""; 0]);
    }
    // Culling on `far-off-corners` got only the hint that the id 0 of the reference stands for nothing.
    let culled = hints("far-off-corners", Mistake::CulledClockwise, false);
    assert!(culled.iter().any(|hint| hint.contains("culled")), "{culled:?}");
}
