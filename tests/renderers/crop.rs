//! A part of the picture alone: its pixels equal the pixels of the whole picture, bit for bit, in both orders.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::four_renderers::{RENDERERS, owners};
use bothways::common::glam::Vec3;
use bothways::common::observe::{Events, Observer};
use bothways::common::raster::Sample;
use bothways::common::scene::material::Light;
use bothways::common::{
    Camera, CameraDescription, Crop, Frame, Mesh, Object, Options, Plane, Projection, Region,
    Scene, Shape, Sphere, View, Work,
};
use bothways::diff::{Class, compare};
use bothways::formats::generate::Kind;
use bothways::picture::{mask, picture};
use bothways::scenes::LoadedScene;
use bothways::{rasterize, raytrace, scenes, vectors};
use bothways_test_support::{
    PROJECTIONS, assert_is_part, mesh, scene, some_crops, triangle, turned,
};
use std::collections::HashSet;

/// One pixel in each corner, the whole image, two borders, and three random crops.
fn crops_of([width, height]: [u32; 2], seed: u64) -> Vec<Crop> {
    let corners = [[0, 0], [0, width - 1], [height - 1, 0], [height - 1, width - 1]];
    let corners = corners.map(|[row, column]| [row, column, 1, 1]);
    let borders = [[0, 0, height, width], [height - 1, 0, 1, width], [0, width - 1, height, 1]];
    let fixed = corners.into_iter().chain(borders).map(Crop::from);
    fixed.chain(some_crops([width, height], seed).take(3)).collect()
}

/// Asserts that each renderer draws some crops as it draws those parts of the whole picture.
fn check_all(view: &View, samples: u32, seed: u64, what: &str) {
    let options = Options { samples, ..Options::default() };
    for (name, render) in RENDERERS {
        let whole = render(view, &options);
        for crop in crops_of(view.camera.image(), seed) {
            let part = render(view, &Options { crop: Some(crop), ..options });
            assert_is_part(&whole, &part, &format!("{what}, {name}"));
        }
    }
}

#[test]
fn crops_of_built_in_scenes_equal_the_whole() {
    let mut seed = 0;
    for name in ["overlap", "ties", "slivers", "inside", "behind"] {
        let scene = scenes::load(name).unwrap().scene;
        for projection in PROJECTIONS {
            for (eye, image) in [([1.5, 1.0, 4.0], [11, 7]), ([0.2, 0.1, -0.3], [6, 9])] {
                let camera = turned(projection, eye, [0.0; 3], image);
                seed += 1;
                let samples = 1 + u32::try_from(seed % 3).unwrap();
                let what = format!("{name}, {projection:?} from {eye:?}, {samples} samples");
                check_all(&View::new(&scene, &camera), samples, seed, &what);
            }
        }
    }
}

#[test]
fn crops_of_the_conformance_set_equal_the_whole() {
    for (seed, vector) in (0..).zip(vectors::all()) {
        let (scene, camera) = (vector.scene(), vector.camera());
        let small = CameraDescription { image: [13, 11], ..*camera.description() };
        let camera = Camera::new(small).unwrap();
        let samples = 1 + u32::try_from(seed % 2).unwrap();
        check_all(&View::new(&scene, &camera), samples, seed, vector.name);
    }
}

/// Nearly each sample shows another triangle: more than are kept while the picture is shaded.
#[test]
fn crops_of_triangles_as_small_as_samples_equal_the_whole() {
    let LoadedScene { scene, camera, .. } = scenes::load("many").unwrap();
    let wide = scene.clone().with_wide_ids();
    let [width, height] = camera.viewport.map(|side| 1.7 * side);
    let camera = CameraDescription { viewport: [width, height], image: [600, 450], ..camera };
    let camera = Camera::new(camera).unwrap();
    let view = View::new(&scene, &camera);
    for (name, render) in &RENDERERS[2..] {
        let whole = render(&view, &Options::default());
        let ids: HashSet<_> = whole.ids().iter().collect();
        assert!(ids.len() > 9000, "{name}: {}", ids.len());
        for crop in crops_of(camera.image(), 11) {
            let part = render(&view, &Options { crop: Some(crop), ..Options::default() });
            assert_is_part(&whole, &part, name);
        }
        let of_wide = render(&View::new(&wide, &camera), &Options::default());
        assert!(of_wide.picture() == whole.picture(), "{name}");
    }
}

/// Triangles of all sizes, some behind the eye, a textured ball and a plane; with points of light, one of them near the plane.
fn mixed_scene() -> Scene {
    let number = |k: u32, step: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "it looks random")]
        let number = (f64::from(k) * step).fract() as f32 - 0.5;
        number
    };
    let point = |k: u32| {
        Vec3::new(number(k, 0.618_033_988), number(k, 0.754_877_666), number(k, 0.569_840_291))
    };
    let positions = (0..600).flat_map(|k| {
        let size = 4.0 * 0.5f32.powf((k % 12) as f32);
        [0, 1, 2].map(|corner| 4.0 * point(7 * k + 1) + size * point(11 * k + corner + 5))
    });
    let triangles = (0..600).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let soup = mesh(Mesh::new(positions.collect(), triangles).unwrap());
    let lecture = scenes::load("lecture").unwrap().scene;
    let mut materials = lecture.objects().iter().map(|object| &object.material);
    let checkered = materials.find(|material| material.checker.is_some()).unwrap();
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.5, 0.4, 0.0), radius: 0.6 });
    let ground = Shape::Plane(Plane { point: Vec3::new(0.0, -1.0, 0.0), normal: Vec3::Y });
    let textured = |shape| Object { material: checkered.clone(), ..Object::from(shape) };
    let teapot = Kind::Teapot.mesh([6, 6]).unwrap();
    let mut scene = scene(vec![soup, textured(ball), textured(ground), mesh(teapot)]);
    let lights = [[-4.0, 5.0, 2.0], [3.0, -0.9, 1.0]].map(Vec3::from);
    scene.lights.extend(lights.map(|position| Light::Point { position, intensity: 0.4 }));
    scene
}

/// The frames and the counts of both `fast` renderers with tiles of these sizes. Each frame has held another crop, and is
/// drawn twice. Where it does not keep texture coordinates, patterns are found along stretches of samples.
fn draw_both(
    view: &View,
    options: &Options,
    (tile, side): ([u32; 2], usize),
    keeps_textures: bool,
) -> [(Frame, Work); 2] {
    let level = bothways::common::engine::simd::best_level();
    let mut drawn = [(); 2].map(|()| {
        let elsewhere = Options { crop: Some([0, 1, 3, 5].into()), ..*options };
        let frame = Frame::new(view.camera, &elsewhere).with_colors().with_normals();
        let frame = if keeps_textures { frame.with_texture_coordinates() } else { frame };
        (frame, Work::default())
    });
    let [(by_object, object_work), (by_image, image_work)] = &mut drawn;
    let prepared = rasterize::fast::prepare(view.scene).drawn_with(level, tile);
    rasterize::fast::determine_visibility(&prepared, view, options, by_object, object_work);
    rasterize::fast::determine_visibility(&prepared, view, options, by_object, &mut ());
    rasterize::shade(view, by_object);
    let prepared = raytrace::fast::prepare(view.scene).drawn_with(level, side);
    raytrace::fast::determine_visibility(&prepared, view, options, by_image, image_work);
    raytrace::fast::determine_visibility(&prepared, view, options, by_image, &mut ());
    raytrace::shade(view, by_image);
    drawn
}

#[test]
fn crops_that_cut_tiles_equal_the_whole_on_any_number_of_threads() {
    let (scene, image) = (mixed_scene(), [139, 75]);
    let mut seed = 100;
    for projection in PROJECTIONS {
        for eye in [[1.5, 1.0, 4.0], [0.1, -0.2, 0.3]] {
            let camera = turned(projection, eye, [0.0; 3], image);
            let view = View::new(&scene, &camera);
            for (tile, side) in [([6, 10], 16), ([4, 3], 32), ([3, 6], 16)] {
                seed += 1;
                let samples = 1 + u32::try_from(seed % 2).unwrap();
                let options = Options { samples, ..Options::default() };
                let keeps_textures = seed % 4 < 2;
                let draw =
                    |options: &Options| draw_both(&view, options, (tile, side), keeps_textures);
                let wholes = draw(&options);
                for crop in crops_of(image, seed) {
                    let options = Options { crop: Some(crop), ..options };
                    let on = |threads: usize| {
                        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                        pool.unwrap().install(|| draw(&options))
                    };
                    let parts = on(1);
                    let what = format!("{projection:?} from {eye:?}, tiles {tile:?} and {side}");
                    for ((whole, _), (part, _)) in wholes.iter().zip(&parts) {
                        assert_is_part(whole, part, &what);
                    }
                    assert!(parts == on(3), "{what}, 3 threads");
                }
            }
        }
    }
}

/// A ball of small triangles, whose normals are not all of length 1, and in places point in opposite directions.
fn rough_ball() -> Scene {
    let ball = Kind::Sphere.mesh([40, 21]).unwrap();
    let mut normals = ball.normals().clone();
    for (k, normal) in normals.values.iter_mut().enumerate() {
        if k % 7 == 0 {
            *normal *= 1.3;
        } else if k % 11 == 0 {
            *normal = -*normal;
        }
    }
    scene(vec![mesh(ball.with_normals(normals).unwrap())])
}

/// Triangles with normals are set up eight at a time where many are seen, and alone where one is.
#[test]
fn a_pixel_alone_has_the_normals_and_colors_of_the_whole_picture() {
    let (scene, image) = (rough_ball(), [90, 70]);
    let mut seen = 0;
    for projection in PROJECTIONS {
        let camera = turned(projection, [0.9, 0.6, 1.4], [0.0; 3], image);
        let view = View::new(&scene, &camera);
        let draw = |options: &Options| {
            let new = || Frame::new(view.camera, options).with_colors().with_normals();
            let (mut by_object, mut by_image) = (new(), new());
            let prepared = rasterize::fast::prepare(&scene);
            rasterize::fast::determine_visibility(
                &prepared,
                &view,
                options,
                &mut by_object,
                &mut (),
            );
            rasterize::shade(&view, &mut by_object);
            let prepared = raytrace::fast::prepare(&scene);
            raytrace::fast::determine_visibility(&prepared, &view, options, &mut by_image, &mut ());
            raytrace::shade(&view, &mut by_image);
            [by_object, by_image]
        };
        let wholes = draw(&Options::default());
        for pixel in some_crops(image, 7).take(80) {
            let pixel = Crop { width: 1, height: 1, ..pixel };
            let parts = draw(&Options { crop: Some(pixel), ..Options::default() });
            for ((whole, part), order) in wholes.iter().zip(&parts).zip(["object", "image"]) {
                assert_is_part(whole, part, &format!("{projection:?}, {order} order"));
                seen += part.ids().covered();
            }
        }
    }
    assert!(seen > 60, "{seen}");
}

/// The region of a crop, and the number of events that reach outside of it.
#[derive(Clone, Debug)]
struct Within {
    region: Region,
    outside: u64,
}

impl Observer for Within {
    fn fork(&self) -> Self {
        Within { outside: 0, ..self.clone() }
    }

    fn join(&mut self, part: Self) {
        self.outside += part.outside;
    }
}

impl Events for Within {
    fn primitive_begun(&mut self, _primitive: u64, region: &Region) {
        let is_within = region.is_empty() || region.intersection(&self.region) == *region;
        self.outside += u64::from(!is_within);
    }

    fn ray_begun(&mut self, Sample { row, column }: Sample) {
        let is_within = self.region.rows.contains(&row) && self.region.columns.contains(&column);
        self.outside += u64::from(!is_within);
    }
}

#[test]
fn events_stay_inside_the_crop_and_number_samples_in_the_whole_image() {
    let scene = mixed_scene();
    for projection in PROJECTIONS {
        let camera = turned(projection, [1.5, 1.0, 4.0], [0.0; 3], [26, 20]);
        let view = View::new(&scene, &camera);
        let whole = Options { samples: 2, ..Options::default() };
        let crop = Crop { row: 11, column: 5, height: 7, width: 18 };
        let part = Options { crop: Some(crop), ..whole };
        let region = crop.region(2);
        for ((name, all), (_, some)) in owners(&view, &whole).into_iter().zip(owners(&view, &part))
        {
            for (index, (all, some)) in all.into_iter().zip(some).enumerate() {
                let (row, column) = (index / 52, index % 52);
                let is_in = region.rows.contains(&row) && region.columns.contains(&column);
                let expected = if is_in { all } else { 0 };
                assert_eq!(some, expected, "{name}, sample ({row}, {column})");
            }
        }
        let [(by_object, object_work), (_, image_work)] =
            draw_both(&view, &part, ([10, 6], 16), true);
        assert_eq!(by_object.region(), &region);
        // Object order begins every primitive, however small the crop; image order begins the crop's rays alone.
        assert_eq!(object_work.primitives, scene.primitive_count());
        assert_eq!((image_work.rays, object_work.rays), (4 * 7 * 18, 0));

        let mut within = Within { region, outside: 0 };
        let mut frame = Frame::new(&camera, &part);
        rasterize::textbook::determine_visibility(&view, &part, &mut frame, &mut within);
        raytrace::textbook::determine_visibility(&view, &part, &mut frame, &mut within);
        let prepared = rasterize::fast::prepare(&scene);
        rasterize::fast::determine_visibility(&prepared, &view, &part, &mut frame, &mut within);
        let prepared = raytrace::fast::prepare(&scene);
        raytrace::fast::determine_visibility(&prepared, &view, &part, &mut frame, &mut within);
        assert_eq!(within.outside, 0);
    }
}

#[test]
fn differing_pixels_are_numbered_in_the_whole_image() {
    let scene = scene(vec![triangle([[-1.0, -1.0, -2.0], [1.0, -1.0, -2.0], [0.0, 1.0, -2.0]])]);
    let camera = turned(Projection::Perspective, [0.0; 3], [0.0, 0.0, -1.0], [9, 8]);
    let options = Options { samples: 2, crop: Some([3, 2, 4, 5].into()) };
    let frame = rasterize::textbook::render(&View::new(&scene, &camera), &options);
    let mut other = frame.clone();
    // A sample of pixel (4, 6), the last column, and two of pixel (6, 2), the last row.
    for (row, column) in [(9, 13), (12, 4), (13, 5)] {
        other.set(row, column, 7, 1.0);
    }
    let comparison = compare(&frame, &other);
    assert_eq!(comparison.visible.first_differing, [[4, 6], [6, 2]]);
    assert_eq!(comparison.visible.differing_pixels, 2);
    assert!(comparison.verdict().contains("first at (4, 6)"), "{}", comparison.verdict());
    let classes = comparison.classes();
    assert_eq!(classes.image(), [5, 4]);
    assert!(classes.at(1, 4).differs() && classes.at(3, 0).differs());
    let differing = Class::ALL.into_iter().filter(|class| class.differs());
    assert_eq!(differing.map(|class| classes.count(class)).sum::<u64>(), 2);
    assert_eq!((picture(&frame).dimensions(), mask(&frame).dimensions()), ((5, 4), (5, 4)));
}

#[test]
#[should_panic(expected = "the frames show different views")]
fn two_crops_of_one_size_are_not_compared() {
    let camera = Camera::canonical(9, 9);
    let frame = |row| {
        let crop = Some(Crop { row, column: 0, height: 2, width: 2 });
        Frame::new(&camera, &Options { crop, ..Options::default() })
    };
    compare(&frame(0), &frame(1));
}
