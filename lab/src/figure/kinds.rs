//! The kinds of figures, one file each.

mod both;
mod camera;
mod counts;
mod depth_complexity;
mod edge_functions;
mod grid;
mod hierarchy;
mod image;
mod interest;
mod levels;
mod one_ray;
mod order;
mod patch;
mod ray;
mod reasons;
mod side_by_side;
mod work;
mod zoom;

pub use work::{WorkMap, work_at_samples, work_figure, work_maps};

use super::drawing::Drawing;
use super::subject::{FigureError, Subject};
use std::fmt;

/// What a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// What an image is: rows and columns of pixels, each with a colour.
    Image,
    /// The lecture's drawing: eye, u, v, w, viewport, viewing rays and what they hit.
    Camera,
    /// A magnified patch: samples, edges, signs of the edge functions, the tie rule at work.
    Grid,
    /// Three half-planes of one triangle, and their intersection.
    EdgeFunctions,
    /// One pixel's ray: every primitive that it hits at its t, the boxes that it hits, what is tested, what is seen.
    Ray,
    /// Heat maps of the work at each pixel: both orders, textbook and fast, on one scale.
    Work,
    /// Boxes of the ray tracer by level, clusters and tiles of the rasterizer, over the picture.
    Hierarchy,
    /// Pixels coloured by when each order decided them.
    Order,
    /// How many primitives cover each sample.
    DepthComplexity,
    /// The level of its texture that each order reads at each pixel, and where they differ.
    Levels,
    /// Both pictures, their difference and their work: the slide of render.
    SideBySide,
    /// A patch of all buffers of both orders, around a differing or a chosen pixel.
    Zoom,
    /// Why the orders differ when one of them has other rules, pixel by pixel.
    Reasons,
}

impl Kind {
    /// All kinds, in the order of a lecture.
    pub const ALL: [Kind; 13] = [
        Kind::Image,
        Kind::Camera,
        Kind::Grid,
        Kind::EdgeFunctions,
        Kind::Ray,
        Kind::Work,
        Kind::Hierarchy,
        Kind::Order,
        Kind::DepthComplexity,
        Kind::Levels,
        Kind::SideBySide,
        Kind::Zoom,
        Kind::Reasons,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Image => "image",
            Kind::Camera => "camera",
            Kind::Grid => "grid",
            Kind::EdgeFunctions => "edge-functions",
            Kind::Ray => "ray",
            Kind::Work => "work",
            Kind::Hierarchy => "hierarchy",
            Kind::Order => "order",
            Kind::DepthComplexity => "depth-complexity",
            Kind::Levels => "levels",
            Kind::SideBySide => "side-by-side",
            Kind::Zoom => "zoom",
            Kind::Reasons => "reasons",
        }
    }

    /// The kind of this name.
    pub fn named(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What the figure shows, in one line.
    pub fn about(self) -> &'static str {
        match self {
            Kind::Image => "what an image is: rows and columns of pixels, each with a colour",
            Kind::Camera => {
                "the lecture's drawing: eye, u, v, w, viewport, viewing rays and what they hit"
            }
            Kind::Grid => {
                "a magnified patch: samples, edges, signs of the edge functions, the tie rule at work"
            }
            Kind::EdgeFunctions => "three half-planes of one triangle, and their intersection",
            Kind::Ray => {
                "one pixel's ray: every primitive that it hits at its t, the boxes that it hits, what is tested and seen"
            }
            Kind::Work => {
                "heat maps of the work at each pixel: both orders, textbook and fast, on one scale"
            }
            Kind::Hierarchy => {
                "boxes of the ray tracer by level, clusters and tiles of the rasterizer, over the picture"
            }
            Kind::Order => "pixels coloured by when each order decided them",
            Kind::DepthComplexity => "how many primitives cover each sample",
            Kind::Levels => {
                "the level of its texture that each order reads at each pixel, and where they differ"
            }
            Kind::SideBySide => {
                "both pictures, their difference and their work: the slide of render"
            }
            Kind::Zoom => {
                "a patch of all buffers of both orders, around a differing or a chosen pixel"
            }
            Kind::Reasons => {
                "why the orders differ when one of them has other rules, pixel by pixel"
            }
        }
    }

    /// How many chosen pixels the figure can look at.
    pub fn most_pixels(self) -> usize {
        match self {
            Kind::Camera => 4,
            Kind::Image | Kind::Grid | Kind::EdgeFunctions | Kind::Ray | Kind::Zoom => 1,
            Kind::Work
            | Kind::Hierarchy
            | Kind::Order
            | Kind::DepthComplexity
            | Kind::Levels
            | Kind::SideBySide
            | Kind::Reasons => 0,
        }
    }

    /// Whether the figure compares the orders: then rules of ordinary renderers show in it.
    pub fn compares(self) -> bool {
        matches!(self, Kind::SideBySide | Kind::Zoom | Kind::Reasons)
    }

    /// Whether the figure shows pictures of several samples a pixel.
    pub fn takes_samples(self) -> bool {
        self == Kind::SideBySide
    }

    /// Draws the figure.
    ///
    /// # Errors
    ///
    /// A chosen pixel that the image does not have, and scenes that show nothing of what the figure is about.
    pub fn draw(self, subject: &Subject) -> Result<Drawing, FigureError> {
        subject.check()?;
        match self {
            Kind::Image => image::draw(subject),
            Kind::Camera => camera::draw(subject),
            Kind::Grid => grid::draw(subject),
            Kind::EdgeFunctions => edge_functions::draw(subject),
            Kind::Ray => ray::draw(subject),
            Kind::Work => work::draw(subject),
            Kind::Hierarchy => hierarchy::draw(subject),
            Kind::Order => order::draw(subject),
            Kind::DepthComplexity => depth_complexity::draw(subject),
            Kind::Levels => levels::draw(subject),
            Kind::SideBySide => side_by_side::draw(subject),
            Kind::Zoom => zoom::draw(subject),
            Kind::Reasons => reasons::draw(subject),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
