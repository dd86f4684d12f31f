//! The frames of a film as pictures.

use super::code;
use super::recorded::Film;
use super::shots::{Shot, Shots};
use crate::figure::Theme;
use image::RgbImage;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::io;

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
        let shots = film.shots(theme.nothing());
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
    /// Draws the frames one after another for a function that gets the frame before, the frame, and how long it stays, in
    /// hundredths of a second. Tells `progress` each frame's number, from 1.
    pub(super) fn each_frame(
        &self,
        theme: Theme,
        width: u32,
        progress: &mut dyn FnMut(u32),
        mut write: impl FnMut(Option<&RgbImage>, &RgbImage, u16) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut before = None;
        for (number, picture) in (1..).zip(self.frames(theme, width)) {
            let delay = self.length.hundredths() * self.length.shown(number);
            // A delay has 16 bits in both formats: eleven minutes.
            write(before.as_ref(), &picture, u16::try_from(delay).unwrap_or(u16::MAX))?;
            before = Some(picture);
            progress(number);
        }
        Ok(())
    }

    /// The last frame: the finished picture.
    pub(super) fn last_frame(&self, theme: Theme, width: u32) -> RgbImage {
        let last = self.shots(theme.nothing()).last().expect("a film has a frame");
        self.draw(&last, theme, width)
    }

    /// Some frames from all over the film, the last one too.
    pub(super) fn some_frames(&self, theme: Theme, width: u32) -> Vec<RgbImage> {
        const SOME: usize = 12;
        let all = self.moments.len();
        let chosen = |number: usize| (number + 1) * SOME / all > number * SOME / all;
        let shots = self.shots(theme.nothing()).enumerate();
        let shots: Vec<Shot> =
            shots.filter(|(number, _)| chosen(*number)).map(|(_, shot)| shot).collect();
        shots.par_iter().map(|shot| self.draw(shot, theme, width)).collect()
    }

    fn draw(&self, shot: &Shot, theme: Theme, width: u32) -> RgbImage {
        code::page(self, shot).draw(theme, width).pixels(width)
    }
}
