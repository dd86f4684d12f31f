//! The frames of a film as pictures.

use super::shots::{Shot, Shots};
use super::{Film, code};
use crate::figure::{FilmPage, Theme};
use image::RgbImage;
use rayon::prelude::*;
use std::collections::VecDeque;

/// The frames of a film as pictures, one after another.
#[derive(Debug)]
pub struct Frames<'a> {
    film: &'a Film<'a>,
    theme: Theme,
    width: u32,
    shots: Shots<'a>,
    drawn: VecDeque<RgbImage>,
}

impl<'a> Frames<'a> {
    pub(super) fn new(film: &'a Film<'a>, theme: Theme, width: u32) -> Frames<'a> {
        let shots = film.shots(FilmPage::nothing(theme));
        Frames { film, theme, width, shots, drawn: VecDeque::new() }
    }
}

impl Iterator for Frames<'_> {
    type Item = RgbImage;

    fn next(&mut self) -> Option<RgbImage> {
        if self.drawn.is_empty() {
            // As many at once as there are threads to draw them.
            let threads = rayon::current_num_threads();
            let batch: Vec<Shot> = self.shots.by_ref().take(threads).collect();
            let draw = |shot: &Shot| self.film.draw(shot, self.theme, self.width);
            self.drawn = batch.par_iter().map(draw).collect::<Vec<_>>().into();
        }
        self.drawn.pop_front()
    }
}

impl Film<'_> {
    /// The last frame: the finished picture.
    pub(super) fn last_frame(&self, theme: Theme, width: u32) -> RgbImage {
        let last = self.shots(FilmPage::nothing(theme)).last().expect("a film has a frame");
        self.draw(&last, theme, width)
    }

    /// Some frames from all over the film, the last one too.
    pub(super) fn some_frames(&self, theme: Theme, width: u32) -> Vec<RgbImage> {
        const SOME: usize = 12;
        let all = self.moments.len();
        let chosen = |number: usize| (number + 1) * SOME / all > number * SOME / all;
        let shots = self.shots(FilmPage::nothing(theme)).enumerate();
        let shots: Vec<Shot> =
            shots.filter(|(number, _)| chosen(*number)).map(|(_, shot)| shot).collect();
        shots.par_iter().map(|shot| self.draw(shot, theme, width)).collect()
    }

    fn draw(&self, shot: &Shot, theme: Theme, width: u32) -> RgbImage {
        code::page(self, shot).draw(theme, width).pixels(width)
    }
}
