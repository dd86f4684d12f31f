//! Texture coordinates and textures: object order interpolates, image order computes the coordinates at the hit, and
//! both find the same place of the texture.

use crate::four_renderers::RENDERERS;
use bothways::common::glam::{DVec2, Vec2, Vec3};
use bothways::common::scene::material::Light;
use bothways::common::scene::{Attribute, Pyramid, Sampler, Wrap};
use bothways::common::{
    Camera, Frame, Material, Mesh, Object, Options, Scene, Shape, Texture, Triangle, View,
};
use bothways::diff::compare;
use bothways::formats::scene_file;
use bothways::formats::source::{Files, Reach};
use bothways::scenes::load;
use bothways::{rasterize, raytrace};
use bothways_test_support::{PROJECTIONS, scene, turned};

/// One textured object of every kind, all in front of one camera.
const STILL_LIFE: &str = r##"
[material.tiles]
color = "#f0e0c0"
specular = 0.3
checker = { color = "#803010", divisions = [8, 6] }

[material.floor]
color = "#808080"
checker = { color = "#f0f0f0", divisions = [1.5, 2] }

[[object]]
triangle = { a = [-3, -1, -2], b = [-1, -1, 1], c = [-3, 2, -3] }
material = "tiles"

[[object]]
sphere = { center = [1.5, 0, 0], radius = 0.9 }
material = "tiles"

[[object]]
generate = { kind = "torus", divisions = [24, 12] }
material = "tiles"
rotate = { axis = [1, 0, 0], degrees = 70 }

[[object]]
generate = { kind = "teapot", divisions = [3, 3] }
material = "tiles"
scale = 0.4
translate = [0, 0.6, -1.5]

[[object]]
plane = { point = [0.3, -1, 0], normal = [0.1, 1, 0.05] }
material = "floor"
"##;

fn still_life() -> Scene {
    let file = scene_file::parse("still-life.toml", STILL_LIFE, &Files::none());
    file.expect("it is a scene").scene
}

/// The frames of both orders, with texture coordinates.
fn both(view: &View, options: &Options) -> [Frame; 2] {
    let frames = [(); 2].map(|()| Frame::new(view.camera, options).with_texture_coordinates());
    drawn(view, options, frames)
}

/// Draws and shades a frame in object order, and one in image order.
fn drawn(view: &View, options: &Options, mut frames: [Frame; 2]) -> [Frame; 2] {
    let [by_object, by_image] = &mut frames;
    let prepared = rasterize::fast::prepare(view.scene);
    rasterize::fast::determine_visibility(&prepared, view, options, by_object, &mut ());
    rasterize::shade(view, by_object);
    let prepared = raytrace::fast::prepare(view.scene);
    raytrace::fast::determine_visibility(&prepared, view, options, by_image, &mut ());
    raytrace::shade(view, by_image);
    frames
}

/// The distance between two texture coordinates; 0 and 1 are the same longitude.
fn apart(a: Vec2, b: Vec2) -> f32 {
    let way = (a - b).abs();
    way.x.min((1.0 - way.x).abs()).max(way.y)
}

#[test]
fn both_orders_find_the_same_place_of_the_texture() {
    let scene = still_life();
    for projection in PROJECTIONS {
        for (eye, samples) in [([1.0, 1.5, 6.0], 1), ([-2.0, 0.4, 3.0], 2), ([0.0, 4.0, 0.5], 1)] {
            let camera = turned(projection, eye, [0.0; 3], [80, 60]);
            let view = View::new(&scene, &camera);
            let [by_object, by_image] = both(&view, &Options { samples, ..Options::default() });
            let coordinates = by_object.texture_coordinates().iter();
            let mut found = 0;
            for (sample, (&a, &b)) in coordinates.zip(by_image.texture_coordinates()).enumerate() {
                let size = 1_f32.max(a.abs().max_element());
                assert!(apart(a, b) < 2e-5 * size, "{projection:?} {eye:?}: {a} {b} at {sample}");
                found += usize::from(a != Vec2::ZERO);
            }
            assert!(found > 1000, "{found}");
            let comparison = compare(&by_object, &by_image);
            assert_eq!(comparison.color.differing_pixels, 0, "{projection:?} {eye:?}");
        }
    }
}

#[test]
fn all_four_draw_the_pattern() {
    let scene = still_life();
    let plain: Vec<Object> = scene.objects().iter().map(without_checker).collect();
    let plain = Scene::new(plain).unwrap();
    for projection in PROJECTIONS {
        let camera = turned(projection, [1.0, 1.5, 6.0], [0.0; 3], [40, 30]);
        let (view, options) = (View::new(&scene, &camera), Options::default());
        let frames = RENDERERS.map(|(_, render)| render(&view, &options));
        for frame in &frames {
            assert_eq!(compare(&frames[0], frame).color.differing_pixels, 0);
            let without = RENDERERS[0].1(&View::new(&plain, &camera), &options);
            assert!(compare(frame, &without).color.differing_pixels > 200, "a pattern is seen");
        }
    }
}

/// Where coordinates are kept, patterns are found from them in `f64`.
#[test]
fn patterns_look_the_same_where_coordinates_are_not_kept() {
    let mut scene = still_life();
    let lights = [[-4.0, 5.0, 2.0], [3.0, -0.9, 1.0]].map(Vec3::from);
    scene.lights.extend(lights.map(|position| Light::Point { position, intensity: 0.4 }));
    let options = Options::default();
    for projection in PROJECTIONS {
        for (eye, target) in [([1.0, 1.5, 6.0], [0.0; 3]), ([-2.0, 0.2, 5.0], [4.0, -3.0, 0.0])] {
            let camera = turned(projection, eye, target, [300, 200]);
            let view = View::new(&scene, &camera);
            let alone = [(); 2].map(|()| Frame::new(&camera, &options));
            let frames = drawn(&view, &options, alone).into_iter().zip(both(&view, &options));
            for (alone, kept) in frames {
                let [alone, kept] = [&alone, &kept].map(|frame| frame.picture().as_flattened());
                let apart = alone.iter().zip(kept).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(apart <= Some(1), "{projection:?} {eye:?}: {apart:?} of 255");
            }
        }
    }
}

fn without_checker(object: &Object) -> Object {
    let mut object = object.clone();
    object.material.checker = None;
    object
}

/// A long floor of one triangle: halfway up the picture is much less than halfway to its end.
#[test]
fn coordinates_are_right_in_perspective() {
    let far = Triangle {
        a: Vec3::new(-1.0, -1.0, -1.0),
        b: Vec3::new(1.0, -1.0, -1.0),
        c: Vec3::new(-1.0, -1.0, -9.0),
    };
    let scene = scene(vec![Shape::Triangle(far).into()]);
    let camera = Camera::canonical(64, 64);
    let grid = camera.sample_grid(1);
    for frame in both(&View::new(&scene, &camera), &Options::default()) {
        let mut seen = 0;
        for (row, &y) in grid.y().iter().enumerate() {
            for (column, &x) in grid.x().iter().enumerate() {
                if frame.id(row, column).is_none() {
                    continue;
                }
                // The viewing ray t·(x, y, −d) meets the floor y = −1; `c` is 8 behind `a`.
                let t = -1.0 / y;
                let depth = t * camera.distance();
                let expected = DVec2::new(0.5 * (x * t + 1.0), (depth - 1.0) / 8.0);
                let found = frame.texture_coordinates()[row * frame.width() + column].as_dvec2();
                assert!((found - expected).abs().max_element() < 1e-6, "{found} {expected}");
                seen += 1;
            }
        }
        assert!(seen > 50, "{seen}");
    }
}

#[test]
fn a_frame_keeps_no_coordinates_unless_asked() {
    let loaded = load("canonical").unwrap();
    let camera = Camera::new(loaded.camera).unwrap();
    let view = View::new(&loaded.scene, &camera);
    let frame = RENDERERS[0].1(&view, &Options::default());
    assert!(frame.texture_coordinates().is_empty());
    let mut frame = frame.with_texture_coordinates();
    let small = Camera::canonical(5, 7);
    frame.fit(&View::new(&loaded.scene, &small), &Options::default());
    assert_eq!(frame.texture_coordinates().len(), 35, "a frame of another size keeps them, too");
}

#[test]
fn a_mesh_without_coordinates_takes_no_checker() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bare.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let text = "[material.tiles]\nchecker = { color = '#000000', divisions = [4, 4] }\n\
                [[object]]\nmesh = 'bare.obj'\nmaterial = 'tiles'\n";
    let error = scene_file::parse("a.toml", text, &Files::in_folder(folder.path(), Reach::Folder))
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.toml:5:1: this material has a checker, and the mesh has no texture coordinates; export \
         the mesh with texture coordinates, as OBJ (vt) or glTF, or choose a material without checker"
    );
}

/// A picture without symmetry, of odd sides.
fn picture(sampler: Sampler) -> Texture {
    let value = |k: usize| (k as f32 * 0.618_034).fract();
    let texels = (0..13 * 9).map(|k| Vec3::new(value(k), value(3 * k + 1), value(7 * k)));
    Texture { pyramid: Pyramid::new(13, texels.collect()).into(), sampler }
}

/// The still life with a texture in the place of each pattern.
fn textured(sampler: Sampler) -> Scene {
    let scene = still_life();
    let objects = scene.objects().iter().map(|object| {
        let mut object = object.clone();
        object.material.checker = None;
        object.material.texture = Some(picture(sampler));
        object
    });
    Scene::new(objects.collect()).expect("it is a scene")
}

#[test]
fn both_orders_read_the_same_texels() {
    for (filter, wrap) in [
        (Sampler::NEAREST, [Wrap::Repeat, Wrap::Mirror]),
        (Sampler::BILINEAR, [Wrap::Clamp, Wrap::Repeat]),
        (Sampler::BILINEAR, [Wrap::Mirror, Wrap::Clamp]),
    ] {
        let scene = textured(Sampler { wrap, tiles: [2.0, 1.5], ..filter });
        for projection in PROJECTIONS {
            for (eye, samples) in [([1.0, 1.5, 6.0], 1), ([-2.0, 0.4, 3.0], 2)] {
                let camera = turned(projection, eye, [0.0; 3], [80, 60]);
                let view = View::new(&scene, &camera);
                let frames = both(&view, &Options { samples, ..Options::default() });
                let comparison = compare(&frames[0], &frames[1]);
                assert_eq!(
                    comparison.color.differing_pixels, 0,
                    "{filter:?} {projection:?} {eye:?}"
                );
                let plain = still_life();
                let plain = both(&View::new(&plain, &camera), &frames[0].options());
                assert!(compare(&frames[0], &plain[0]).color.differing_pixels > 1000);
            }
        }
    }
}

/// Texels, samples and the eye on one grid: every second sample of a row is on a border between texels.
#[test]
fn where_texels_and_samples_are_aligned_both_orders_choose_alike() {
    let wall = |x: f32| {
        let corner = |x: f32, y: f32| Vec3::new(x, y, -1.0);
        [corner(-x, -x), corner(x, -x), corner(x, x), corner(-x, x)]
    };
    let mesh = Mesh::new(wall(0.5).to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let values = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
    let corners = vec![[0, 1, 2], [0, 2, 3]];
    let mesh = mesh.with_texture_coordinates(Attribute { values, corners }).unwrap();
    let texels: Vec<Vec3> = (0..64).map(|k| Vec3::splat(f32::from(k % 3 == 0))).collect();
    let texture = Texture { pyramid: Pyramid::new(8, texels).into(), sampler: Sampler::NEAREST };
    let material = Material { texture: Some(texture), ..Material::default() };
    let scene = scene(vec![Object { shape: Shape::Mesh(mesh), material }]);
    // A pixel is 1/15 of the wall: the middle one is on a border, and in 120 pixels of 1/120 many are.
    for side in [15, 45, 120, 121, 135] {
        let camera = Camera::canonical(side, side);
        let [by_object, by_image] = both(&View::new(&scene, &camera), &Options::default());
        assert_eq!(by_object.picture(), by_image.picture(), "{side}");
    }
}

/// The frames of both orders, with levels.
fn with_levels(view: &View, options: &Options) -> [Frame; 2] {
    both(view, options).map(|frame| {
        let mut frame = frame.with_levels();
        frame.fit(view, options);
        frame
    })
}

/// Shades both frames again, so that they have levels.
fn both_levels(view: &View, options: &Options) -> [Frame; 2] {
    let [mut by_object, mut by_image] = with_levels(view, options);
    rasterize::shade(view, &mut by_object);
    raytrace::shade(view, &mut by_image);
    [by_object, by_image]
}

/// Where the orders find the same level but for a hundredth, or none, a pixel has the same colour, within a step of 255.
#[test]
fn where_levels_agree_colors_do() {
    let scene = textured(Sampler { tiles: [3.0, 2.0], ..Sampler::MIPMAPS });
    let (mut agreeing, mut apart) = (0, 0);
    for projection in PROJECTIONS {
        for eye in [[1.0, 1.5, 6.0], [-2.0, 0.4, 3.0], [0.0, 4.0, 0.5]] {
            let camera = turned(projection, eye, [0.0; 3], [80, 60]);
            let frames = both_levels(&View::new(&scene, &camera), &Options::default());
            let [one, other] = &frames;
            let levels = one.levels().iter().zip(other.levels());
            let pictures = one.picture().iter().zip(other.picture());
            for ((one, other), (a, b)) in levels.zip(pictures) {
                // Below 0, and above the last level, all are the same.
                let [one, other] = [one, other].map(|level| level.clamp(0.0, 3.0));
                if (one - other).abs() > 0.01 {
                    apart += 1;
                    continue;
                }
                agreeing += 1;
                assert!(
                    (0..3).all(|k| a[k].abs_diff(b[k]) <= 1),
                    "{projection:?} {eye:?}: {a:?} {b:?}"
                );
            }
        }
    }
    assert!(agreeing > 10_000 && apart > 100, "{agreeing} {apart}");
}

/// A wall that faces the eye: a texel is so many pixels, everywhere. There both orders find the level that the formula gives.
#[test]
fn the_level_of_a_wall_is_known() {
    let wall = "[[object]]\nplane = { point = [0, 0, -3], normal = [0, 0, 1] }\nmaterial = 'm'\n\
                [material.m]\nchecker = { color = '#000000', divisions = [1, 1] }\n";
    let scene = scene_file::parse("a.toml", wall, &Files::none()).unwrap().scene;
    for side in [16_u16, 64, 100] {
        let camera = Camera::canonical(side.into(), side.into());
        // Of 256 texels to a unit: a pixel is 1/side of the viewport at distance 1, and three times as wide on the wall.
        let [width, _] = camera.viewport();
        let expected = (3.0 * width / camera.distance() * 256.0 / f64::from(side)).log2();
        for frame in both_levels(&View::new(&scene, &camera), &Options::default()) {
            assert_eq!(frame.levels().len(), usize::from(side).pow(2));
            for level in frame.levels() {
                let apart = f64::from(*level) - expected;
                assert!(apart.abs() < 1e-4, "{side}: {level} {expected}");
            }
        }
    }
}

/// On a floor, a row at `k` rows and a half below the horizon has the level of `1/k²`; the difference of a pair of rows has
/// that of `1/(k(k + 1))`, for both of its rows.
#[test]
fn on_a_floor_object_order_finds_levels_in_pairs() {
    let floor = "[[object]]\nplane = { point = [0, -1, 0], normal = [0, 1, 0] }\nmaterial = 'm'\n\
                 [material.m]\nchecker = { color = '#000000', divisions = [1, 1] }\n";
    let scene = scene_file::parse("a.toml", floor, &Files::none()).unwrap().scene;
    let camera = Camera::canonical(64, 64);
    let [by_object, by_image] = both_levels(&View::new(&scene, &camera), &Options::default());
    let (grid, texels) = (camera.sample_grid(1), 256.0);
    // The floor is seen at a depth of d/−y; its texture goes up with the depth.
    let depth = |row: usize| camera.distance() / -grid.y()[row];
    let step = grid.y()[0] - grid.y()[1];
    let mut pairs = 0;
    for row in (32..64).step_by(2) {
        let at = |frame: &Frame, row: usize| f64::from(frame.levels()[row * 64 + 31]);
        let expected = (texels * (depth(row) - depth(row + 1))).log2();
        for row in [row, row + 1] {
            let derivative = (texels * step * depth(row) / -grid.y()[row]).log2();
            assert!((at(&by_object, row) - expected).abs() < 1e-3, "{row}");
            assert!((at(&by_image, row) - derivative).abs() < 1e-3, "{row}");
        }
        pairs += usize::from((at(&by_object, row) - at(&by_image, row)).abs() > 0.05);
    }
    assert!(pairs > 4, "{pairs}");
}
