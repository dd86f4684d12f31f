//! Polygons of every kind, and what their triangles cover.

use super::*;
use proptest::collection::vec;
use proptest::prelude::*;

/// A corner in whole numbers, so that areas are exact.
type Whole = [i32; 2];

/// The triangles of a polygon, as numbers of its corners.
fn cut(position: impl Fn(usize) -> Vec3, corners: usize) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    let numbers: Vec<usize> = (0..corners).collect();
    Cutter::default().visit(&numbers, position, |triangle| triangles.push(triangle));
    triangles
}

#[expect(clippy::cast_precision_loss, reason = "small numbers")]
fn level([x, y]: Whole) -> Vec3 {
    Vec3::new(x as f32, y as f32, 0.0)
}

fn twice_the_area(polygon: &[Whole]) -> i64 {
    let next = polygon.iter().cycle().skip(1);
    let product = |a: i32, b: i32| i64::from(a) * i64::from(b);
    polygon.iter().zip(next).map(|(a, b)| product(a[0], b[1]) - product(a[1], b[0])).sum()
}

/// Triangles that go around as the polygon does cover each point as often as the polygon goes around it; and they do if their areas
/// have its sign and their sum is its area. So no inner point is left out, and none is covered twice.
fn assert_covers(polygon: &[Whole], triangles: &[[usize; 3]]) {
    let area = twice_the_area(polygon);
    let areas = triangles.iter().map(|of| twice_the_area(&of.map(|k| polygon[k])));
    assert_eq!(areas.clone().sum::<i64>(), area, "{polygon:?}: {triangles:?}");
    assert_eq!(areas.map(i64::abs).sum::<i64>(), area.abs(), "{polygon:?}: {triangles:?}");
    assert_eq!(triangles.len(), polygon.len() - 2, "{polygon:?}");
    let mut named: Vec<usize> = triangles.as_flattened().to_vec();
    named.sort_unstable();
    named.dedup();
    assert_eq!(named, (0..polygon.len()).collect::<Vec<_>>(), "{triangles:?}");
}

/// Checks a polygon with each corner as its first one, both ways around, and on planes that look in all directions.
fn assert_all_cover(polygon: &[Whole]) {
    let planes: [fn(f32, f32) -> [f32; 3]; 5] = [
        |x, y| [x, y, 0.0],
        |x, y| [x, 7.0, y],
        |x, y| [3.0 * x - y, y, x],
        |x, y| [y, x, 4.0 * y + x],
        |x, y| [x + 5.0 * y, x - 5.0 * y, x],
    ];
    for first in 0..polygon.len() {
        let mut turned = polygon.to_vec();
        turned.rotate_left(first);
        for polygon in [turned.clone(), turned.into_iter().rev().collect()] {
            for plane in planes {
                let place = |k: usize| Vec3::from(plane(level(polygon[k]).x, level(polygon[k]).y));
                assert_covers(&polygon, &cut(place, polygon.len()));
            }
        }
    }
}

const ARROW: [Whole; 4] = [[0, 0], [2, 1], [0, 2], [1, 1]];
const L: [Whole; 6] = [[2, 0], [2, 1], [1, 1], [1, 2], [0, 2], [0, 0]];
const U: [Whole; 8] = [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]];
const STAR: [Whole; 10] = [
    [100, 0],
    [32, 24],
    [31, 95],
    [-12, 38],
    [-81, 59],
    [-40, 0],
    [-81, -59],
    [-12, -38],
    [31, -95],
    [32, -24],
];

/// A corridor that goes round and round, in so many steps of a right angle.
fn spiral(steps: i32) -> Vec<Whole> {
    let at = |step: i32, radius: i32| match step % 4 {
        0 => [radius, 0],
        1 => [0, radius],
        2 => [-radius, 0],
        _ => [0, -radius],
    };
    let outer = (0..steps).map(|step| at(step, step + 4));
    outer.chain((0..steps).rev().map(|step| at(step, step + 3))).collect()
}

#[test]
fn polygons_that_are_not_convex_are_covered_whatever_their_first_corner() {
    for polygon in [&ARROW[..], &L, &U, &STAR] {
        assert_all_cover(polygon);
    }
    let teeth: Vec<Whole> = (0..20).map(|k| [k, 10 * (k % 2)]).chain([[20, 11], [0, 11]]).collect();
    assert_all_cover(&teeth);
    assert_all_cover(&spiral(3));
    assert_all_cover(&spiral(21));
}

#[test]
fn a_convex_polygon_stays_the_fan_also_where_its_corners_lie_in_no_plane() {
    let fan = |corners: usize| -> Vec<[usize; 3]> { (2..corners).map(|k| [0, k - 1, k]).collect() };
    let eight: [Whole; 8] = [[1, 0], [3, 0], [4, 1], [4, 3], [3, 4], [1, 4], [0, 3], [0, 1]];
    assert_eq!(cut(|k| level(eight[k]), 8), fan(8));
    for bent in [0.9, 1e-30] {
        let saddle =
            |k: usize| level(eight[k]).with_z(if k.is_multiple_of(2) { bent } else { 0.0 });
        assert_eq!(cut(saddle, 8), fan(8));
    }
    // So does one with corners on its edges, and one whose fan covers it from this corner.
    let straight: [Whole; 7] = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [0, 2], [0, 1]];
    assert_eq!(cut(|k| level(straight[k]), 7), fan(7));
    let turned: [usize; 4] = [3, 0, 1, 2];
    assert_eq!(cut(|k| level(ARROW[turned[k]]), 4), fan(4));
    assert_ne!(cut(|k| level(ARROW[k]), 4), fan(4));
}

#[test]
fn corners_on_a_line_and_corners_that_repeat_make_triangles_without_area() {
    let straight =
        [[0, 0], [1, 0], [2, 0], [3, 0], [3, 3], [2, 3], [2, 2], [2, 1], [1, 1], [1, 3], [0, 3]];
    assert_all_cover(&straight);
    let twice: Vec<Whole> = U.iter().flat_map(|&corner| [corner; 2]).collect();
    assert_all_cover(&twice);
    let thorn = [[0, 0], [4, 0], [4, 2], [6, 2], [4, 2], [4, 4], [2, 1], [2, 3], [2, 1], [0, 4]];
    assert_all_cover(&thorn);
    // All in one place, and all on a line.
    assert_all_cover(&[[1, 1]; 6]);
    assert_all_cover(&[[0, 0], [2, 0], [1, 0], [5, 0], [3, 0]]);
}

#[test]
fn holes_joined_to_the_outline_by_a_cut_stay_open() {
    let hole = [[0, 0], [12, 0], [12, 12], [0, 12], [0, 0], [4, 4], [4, 8], [8, 8], [8, 4], [4, 4]];
    assert_all_cover(&hole);
    let two = [
        [0, 0],
        [12, 0],
        [12, 12],
        [0, 12],
        [0, 0],
        [2, 2],
        [2, 4],
        [4, 4],
        [6, 6],
        [6, 8],
        [8, 8],
        [8, 6],
        [6, 6],
        [4, 4],
        [4, 2],
        [2, 2],
    ];
    assert_all_cover(&two);
    // A wall that touches the outline in one point.
    assert_all_cover(&[[0, 0], [4, 0], [6, 0], [6, 6], [5, 3], [4, 0], [3, 3], [0, 6]]);
}

#[test]
fn a_polygon_of_thousands_of_corners_is_covered_up_to_a_limit() {
    let long = spiral(2000);
    assert_covers(&long, &cut(|k| level(long[k]), long.len()));
    let comb: Vec<Whole> =
        (0..4000).map(|k| [k, 9 * (k % 2)]).chain([[4000, 10], [0, 10]]).collect();
    assert_covers(&comb, &cut(|k| level(comb[k]), comb.len()));
    // Beyond the limit it is a fan, whatever it covers.
    let beyond = spiral(9000);
    let triangles = cut(|k| level(beyond[k]), beyond.len());
    assert_eq!((triangles.len(), triangles[17_000]), (17_998, [0, 17_001, 17_002]));
}

/// Polygons whose corners are all seen from the origin, in the order of their directions.
fn star_shaped() -> impl Strategy<Value = Vec<Whole>> {
    vec([-40..41, -40..41], 1..30).prop_map(|mut corners: Vec<Whole>| {
        corners.extend([[30, 0], [-1, 20], [-2, -25]]);
        corners.retain(|&corner| corner != [0, 0]);
        let half = |of: &Whole| (of[1], of[0]) < (0, 0);
        let around =
            |a: &Whole, b: &Whole| half(a).cmp(&half(b)).then((a[1] * b[0]).cmp(&(a[0] * b[1])));
        corners.sort_by(around);
        corners.dedup_by(|a, b| around(a, b).is_eq());
        corners
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn triangles_of_star_shaped_polygons_cover_them(polygon in star_shaped()) {
        assert!(twice_the_area(&polygon) > 0);
        assert_all_cover(&polygon);
    }

    /// Polygons that grow: each corner that is added makes a dent or a bump in an edge, and crosses nothing.
    #[test]
    fn triangles_of_polygons_of_any_shape_cover_them(
        steps in vec(([-9..10, -9..10], 0_usize..1000), 0..60),
    ) {
        let mut polygon: Vec<Whole> = vec![[-9, -9], [9, -9], [0, 9]];
        for (corner, edge) in steps {
            let edge = edge % polygon.len();
            let mut grown = polygon.clone();
            grown.insert(edge + 1, corner);
            if is_simple(&grown) {
                polygon = grown;
            }
        }
        assert_all_cover(&polygon);
    }

    #[test]
    fn any_corners_give_as_many_triangles_and_always_the_same(
        corners in vec([-3..4, -3..4, -1..2], 4..40),
    ) {
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let position = |k: usize| Vec3::from(corners[k].map(|value: i32| value as f32));
        let triangles = cut(position, corners.len());
        prop_assert_eq!(triangles.len(), corners.len() - 2);
        prop_assert!(triangles.as_flattened().iter().all(|&corner| corner < corners.len()));
        // What a cutter has cut before makes no difference.
        let mut cutter = Cutter::default();
        cutter.cut(STAR.len(), |k| level(STAR[k]));
        let numbers: Vec<usize> = (0..corners.len()).collect();
        let mut again = Vec::new();
        cutter.visit(&numbers, position, |triangle| again.push(triangle));
        prop_assert_eq!(again, triangles);
    }
}

/// Tells whether no two edges of a polygon touch, but for neighbours in the corner that they share.
fn is_simple(polygon: &[Whole]) -> bool {
    let count = polygon.len();
    let side = |a: Whole, b: Whole, c: Whole| twice_the_area(&[a, b, c]).signum();
    let edge = |k: usize| [polygon[k % count], polygon[(k + 1) % count]];
    let is_on = |[a, b]: [Whole; 2], c: Whole| {
        let is_between = |k: usize| a[k].min(b[k]) <= c[k] && c[k] <= a[k].max(b[k]);
        side(a, b, c) == 0 && is_between(0) && is_between(1)
    };
    (0..count).all(|k| {
        let [a, b] = edge(k);
        let is_edge = a != b && !is_on([a, b], edge(k + 1)[1]) && !is_on(edge(k + 1), a);
        is_edge
            && (k + 2..count).filter(|&other| (other + 1) % count != k).all(|other| {
                let [c, d] = edge(other);
                let crosses =
                    side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
                let touches =
                    is_on([a, b], c) || is_on([a, b], d) || is_on([c, d], a) || is_on([c, d], b);
                !crosses && !touches
            })
    })
}
