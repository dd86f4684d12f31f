//! Plays the records of both orders on one clock.

use super::recorder::{Line, Position};
use super::track::Track;
use image::{Rgb, RgbImage};

/// What a frame of a film shows.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The number of the frame, from 1.
    pub frame: u32,
    /// The clock: the steps that each order has had time for.
    pub clock: u64,
    /// Object order, image order.
    pub orders: [OrderShot; 2],
}

/// What a frame of a film shows of one order.
#[derive(Clone, Debug)]
pub struct OrderShot {
    /// The picture so far; where pixels store nothing yet, a chequerboard of the colours that were given for that.
    pub picture: RgbImage,
    /// The steps so far.
    pub steps: u64,
    /// Whether both loops are over.
    pub done: bool,
    /// The pixels that look as in the finished picture.
    pub finished: u64,
    /// Where the loops are.
    pub position: Position,
    /// The pixels `[i, j]` that changed since the frame before.
    pub fresh: Vec<[u32; 2]>,
}

/// The frames of a film, one after another.
#[derive(Clone, Debug)]
pub struct Shots<'a> {
    moments: &'a [u64],
    players: [Player<'a>; 2],
    /// Frames given so far.
    given: usize,
}

impl<'a> Shots<'a> {
    pub(super) fn new(
        moments: &'a [u64],
        tracks: &'a [Track; 2],
        nothing: [[u8; 3]; 2],
    ) -> Shots<'a> {
        let players = tracks.each_ref().map(|track| Player::new(track, nothing.map(Rgb)));
        Shots { moments, players, given: 0 }
    }
}

impl Iterator for Shots<'_> {
    type Item = Shot;

    fn next(&mut self) -> Option<Shot> {
        let (number, &clock) = (self.given, self.moments.get(self.given)?);
        self.given += 1;
        let orders = self.players.each_mut().map(|player| player.play_to(number, clock));
        let frame = u32::try_from(self.given).expect("a film has few frames");
        Some(Shot { frame, clock, orders })
    }
}

/// Plays the record of one order.
#[derive(Clone, Debug)]
struct Player<'a> {
    track: &'a Track,
    picture: RgbImage,
    /// Changes played so far.
    played: usize,
    finished: u64,
}

impl<'a> Player<'a> {
    fn new(track: &'a Track, nothing: [Rgb<u8>; 2]) -> Player<'a> {
        // Viewers know a chequerboard as a sign for nothing, and no scene's background looks like it.
        const CELLS: u32 = 16;
        let (width, height) = track.picture.dimensions();
        let cell = (width.max(height) / CELLS).max(1);
        let is_dark = |x: u32, y: u32| (x / cell + y / cell).is_multiple_of(2);
        let picture = RgbImage::from_fn(width, height, |x, y| nothing[usize::from(is_dark(x, y))]);
        Player { track, picture, played: 0, finished: 0 }
    }

    fn play_to(&mut self, number: usize, clock: u64) -> OrderShot {
        let Track { steps, changes, positions, picture, .. } = self.track;
        let mut fresh = Vec::new();
        while let Some(change) = changes.get(self.played).filter(|change| change.steps <= clock) {
            self.picture.put_pixel(change.column, change.row, change.color);
            self.finished += u64::from(change.stays);
            self.played += 1;
            fresh.push([change.row, change.column]);
        }
        let done = clock >= *steps;
        if done {
            // Whatever stores nothing now shows the background: only the end of the loops tells.
            self.picture.clone_from(picture);
            self.finished = u64::from(picture.width()) * u64::from(picture.height());
        }
        let over = Position { line: Line::Done, ..Position::default() };
        OrderShot {
            picture: self.picture.clone(),
            steps: clock.min(*steps),
            done,
            finished: self.finished,
            position: if done { over } else { positions[number] },
            fresh,
        }
    }
}
