//! What the integration tests share: the four renderers, and small scenes.
#![expect(dead_code, unreachable_pub, reason = "each test takes what it needs")]
#![expect(clippy::cast_possible_truncation, reason = "small numbers")]

use bothways::common::exact::Sign;
use bothways::common::glam::{Vec2, Vec3};
use bothways::common::observe::{Events, Observer};
use bothways::common::raster::Sample;
use bothways::common::{
    Camera, CameraDescription, Crop, Frame, Mesh, Object, Options, Orientation, Projection, Scene,
    Shape, Triangle, View,
};
use bothways::{rasterize, raytrace};
use std::cmp::Ordering;

pub type Render = fn(&View, &Options) -> Frame;

/// One suite, four renderers.
pub const RENDERERS: [(&str, Render); 4] = [
    ("object order, textbook", rasterize::textbook::render),
    ("image order, textbook", raytrace::textbook::render),
    ("object order, fast", |view, options| {
        rasterize::fast::render(&rasterize::fast::prepare(view.scene), view, options)
    }),
    ("image order, fast", |view, options| {
        raytrace::fast::render(&raytrace::fast::prepare(view.scene), view, options)
    }),
];

pub const PROJECTIONS: [Projection; 2] = [Projection::Perspective, Projection::Parallel];

/// Renders with all four and compares ids, distances and normals' looks; gives the first's frame.
pub fn all_agree(view: &View, options: &Options, what: &str) -> Frame {
    let frames = RENDERERS.map(|(name, render)| (name, render(view, options)));
    let (_, expected) = &frames[0];
    for (name, frame) in &frames[1..] {
        assert_same_visibility(expected, frame, &format!("{what}: {name}"));
    }
    frames[0].1.clone()
}

/// Ids equal; distances within the contract's 10⁻⁵.
pub fn assert_same_visibility(expected: &Frame, frame: &Frame, what: &str) {
    let width = expected.width();
    let place = |index: usize| (index / width, index % width);
    for (index, (id, other)) in expected.ids().iter().zip(frame.ids()).enumerate() {
        assert_eq!(id, other, "{what}: sample {:?}", place(index));
    }
    for (index, (t, other)) in expected.distances().iter().zip(frame.distances()).enumerate() {
        let close = t == other || (t - other).abs() <= 1e-5 * t;
        assert!(close, "{what}: t {t} and {other} at sample {:?}", place(index));
    }
}

/// A crop shows what the whole frame shows there, to the last bit.
pub fn assert_is_part(whole: &Frame, part: &Frame, what: &str) {
    let crop = part.crop().expect("it is a crop");
    let ([width, height], n) = (part.image(), part.samples());
    assert_eq!([width, height], [crop.width, crop.height], "{what}");
    assert_eq!(part.ids().len(), (width * height * n * n) as usize, "{what}");
    let bits = |frame: &Frame, sample: usize| {
        let (t, texture) = (frame.distances()[sample], frame.texture_coordinates().get(sample));
        let normal = frame.normals().get(sample).map(|normal| normal.to_array().map(f32::to_bits));
        let color = frame.colors()[sample].to_array().map(f32::to_bits);
        let texture = texture.map(|texture| texture.to_array().map(f32::to_bits));
        (frame.ids()[sample], t.to_bits(), normal, color, texture)
    };
    for [i, j] in part.pixels().map(|pixel| pixel.map(|place| place as usize)) {
        for (here, there) in part.samples_of(i, j).zip(whole.samples_of(i, j)) {
            assert_eq!(
                bits(part, here),
                bits(whole, there),
                "{what}: crop {crop}, pixel ({i}, {j})"
            );
        }
    }
}

/// Crops of an image that look random, the same for the same seed.
pub fn some_crops([width, height]: [u32; 2], seed: u64) -> impl Iterator<Item = Crop> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d;
    let mut below = move |end: u32| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((state >> 33) % u64::from(end)).expect("it is below the end")
    };
    std::iter::repeat_with(move || {
        let (row, column) = (below(height), below(width));
        let (height, width) = (1 + below(height - row), 1 + below(width - column));
        Crop { row, column, height, width }
    })
}

/// An observer that counts exact ties: of edges where they decide, and of distances.
#[derive(Clone, Debug)]
pub struct Ties<'a> {
    view: &'a View<'a>,
    samples: u32,
    pub edge: u64,
    pub distance: u64,
    pub tested: u64,
}

impl<'a> Ties<'a> {
    pub fn new(view: &'a View<'a>, samples: u32) -> Self {
        Ties { view, samples, edge: 0, distance: 0, tested: 0 }
    }
}

impl Observer for Ties<'_> {
    fn fork(&self) -> Self {
        Ties::new(self.view, self.samples)
    }

    fn join(&mut self, part: Self) {
        self.edge += part.edge;
        self.distance += part.distance;
        self.tested += part.tested;
    }
}

impl Events for Ties<'_> {
    fn sample_tested(&mut self, _sample: Sample, _primitive: u32) {
        self.tested += 1;
    }

    fn edge_signs(&mut self, _sample: Sample, _primitive: u32, signs: [Option<Sign>; 3]) {
        let has = |sign| signs.contains(&Some(sign));
        let decided_elsewhere = has(Sign::Negative) && has(Sign::Positive);
        self.edge += u64::from(has(Sign::Zero) && !decided_elsewhere);
    }

    fn depth_test(&mut self, sample: Sample, challenger: u32, holder: u32, _replaced: bool) {
        let ray = self.view.camera.sample_grid(self.samples).ray(sample.row, sample.column);
        let [first, second] = [challenger, holder].map(|id| self.view.primitive(id));
        let at_sample = self.view.judge().compare(&first, &second, &ray).at_sample;
        self.distance += u64::from(at_sample == Ordering::Equal);
    }
}

/// An observer that counts, for every sample, the primitives that cover it.
#[derive(Clone, Debug)]
pub struct Owners {
    width: usize,
    pub counts: Vec<u32>,
}

impl Owners {
    pub fn new(camera: &Camera, options: &Options) -> Self {
        let [width, height] = camera.image().map(|side| (side * options.samples) as usize);
        Owners { width, counts: vec![0; width * height] }
    }
}

impl Observer for Owners {
    fn fork(&self) -> Self {
        Owners { width: self.width, counts: vec![0; self.counts.len()] }
    }

    fn join(&mut self, part: Self) {
        for (count, more) in self.counts.iter_mut().zip(part.counts) {
            *count += more;
        }
    }
}

impl Events for Owners {
    fn fragment(&mut self, sample: Sample, _primitive: u32) {
        self.counts[sample.row * self.width + sample.column] += 1;
    }
}

/// How many primitives cover each sample, as each of the four renderers' loops meet them.
pub fn owners(view: &View, options: &Options) -> [(&'static str, Vec<u32>); 4] {
    let mut counts = [(); 4].map(|()| Owners::new(view.camera, options));
    let mut frame = Frame::new(view.camera, options);
    let [a, b, c, d] = &mut counts;
    rasterize::textbook::determine_visibility(view, options, &mut frame, a);
    raytrace::textbook::determine_visibility(view, options, &mut frame, b);
    let prepared = rasterize::fast::prepare(view.scene);
    rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, c);
    let prepared = raytrace::fast::prepare(view.scene);
    raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, d);
    let mut names = RENDERERS.iter().map(|(name, _)| *name);
    counts.map(|owners| (names.next().expect("there are four"), owners.counts))
}

/// A camera at `eye` that looks down the negative z axis.
pub fn camera(
    projection: Projection,
    eye: [f32; 3],
    viewport: [f32; 2],
    image: [u32; 2],
) -> Camera {
    let eye = Vec3::from_array(eye);
    let description =
        CameraDescription { projection, eye, viewport, image, ..CameraDescription::default() };
    Camera::new(description).expect("it is a camera")
}

/// A camera from anywhere, looking at a point.
pub fn turned(projection: Projection, eye: [f32; 3], target: [f32; 3], image: [u32; 2]) -> Camera {
    let orientation = Orientation::LookAt { target: Vec3::from_array(target), up: Vec3::Y };
    let eye = Vec3::from_array(eye);
    let viewport = match projection {
        Projection::Perspective => [1.5, 1.5],
        Projection::Parallel => [6.0, 6.0],
    };
    let description = CameraDescription {
        projection,
        eye,
        orientation,
        viewport,
        image,
        ..CameraDescription::default()
    };
    Camera::new(description).expect("it is a camera")
}

pub fn triangle(corners: [[f32; 3]; 3]) -> Object {
    let [a, b, c] = corners.map(Vec3::from_array);
    Shape::Triangle(Triangle { a, b, c }).into()
}

pub fn scene(objects: Vec<Object>) -> Scene {
    Scene::new(objects).expect("it is a scene")
}

/// How often the property tests run: more with `BOTHWAYS_LONG` set.
pub fn cases(usual: u32) -> u32 {
    if std::env::var_os("BOTHWAYS_LONG").is_some() { usual * 50 } else { usual }
}

pub fn mesh(mesh: bothways::common::Mesh) -> Object {
    Shape::Mesh(mesh).into()
}

/// The arguments of a command line, single quotes taken off, its comment left out.
pub fn arguments(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for character in line.chars() {
        match character {
            '#' if !quoted => break,
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().expect("there is a first word").push(character),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// A camera whose samples are the integer points from −`half` to `half`, one unit apart.
pub fn on_integers(projection: Projection, half: u32) -> Camera {
    let side = 2 * half + 1;
    camera(projection, [0.0; 3], [side as f32; 2], [side; 2])
}

/// Grids of squares of several sides, their corners on quarters of the camera's samples, and what they are.
pub fn grids_on_quarters() -> impl Iterator<Item = (Scene, Camera, String)> {
    let sides = [(0.25, 96), (0.5, 48), (1.0, 24), (2.0, 12), (4.0, 6), (9.0, 2)];
    PROJECTIONS.into_iter().flat_map(move |projection| {
        sides.into_iter().flat_map(move |(side, squares)| {
            [Vec2::ZERO, Vec2::new(0.25, 0.5)].into_iter().map(move |shift| {
                let what = format!("{projection:?}, squares of {side}, moved by {shift}");
                (scene(vec![grid(side, squares, shift)]), on_integers(projection, 10), what)
            })
        })
    })
}

/// The corners of a grid of squares in the plane z = −1, moved by `shift`, cut by both diagonals in turn.
fn grid(side: f32, squares: usize, shift: Vec2) -> Object {
    let count = squares + 1;
    let half = 0.5 * side * squares as f32;
    let place = |k: usize| {
        let [column, row] = [k % count, k / count].map(|index| side * index as f32 - half);
        Vec3::new(column + shift.x, row + shift.y, -1.0)
    };
    let square = |k: usize| {
        let a = (k / squares * count + k % squares) as u32;
        let [b, c, d] = [a + 1, a + count as u32 + 1, a + count as u32];
        if k.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = (0..squares * squares).flat_map(square).collect();
    mesh(Mesh::new((0..count * count).map(place).collect(), triangles).expect("it is a mesh"))
}
