//! How long a film is: frames, their time, and the pause at the end.

/// The frames a second that a film may have. A GIF counts the time of a frame in hundredths of a second, so these
/// divide 100.
pub const FRAME_RATES: [u32; 9] = [1, 2, 4, 5, 10, 20, 25, 50, 100];

/// The most frames a second of a GIF or an animated PNG: browsers show frames of a hundredth of a second ten times as
/// long.
pub const FASTEST_IN_BROWSERS: u32 = 50;

/// The longest film in seconds, without the pause at its end.
pub const MOST_SECONDS: f64 = 600.0;

/// The most frames of a film, with those of its pause.
pub const MOST_FRAMES: u32 = 10_000;

/// The length of a film.
///
/// ```
/// use bothways_lab::film::Length;
///
/// let length = Length::new(8.0, 25, 2.0)?;
/// assert_eq!((length.frames(), length.pause()), (200, 50));
/// assert_eq!(length.hundredths(), 4);
/// # Ok::<(), bothways_lab::film::LengthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Length {
    rate: u32,
    frames: u32,
    pause: u32,
}

/// Why a film cannot have a length.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LengthError {
    /// The frames would not last whole hundredths of a second.
    #[error(
        "{rate} frames a second are not possible: a GIF counts hundredths of a second; choose {}",
        rates()
    )]
    Rate {
        /// The frames a second.
        rate: u32,
    },
    /// The seconds are no length.
    #[error(
        "a film takes more than 0 and at most {MOST_SECONDS} seconds, and its pause at least 0"
    )]
    Seconds,
    /// Too many frames.
    #[error(
        "the film would have {frames} frames, and {MOST_FRAMES} are the most; choose fewer seconds, or \
         fewer frames a second"
    )]
    Frames {
        /// The frames, with those of the pause.
        frames: u64,
    },
}

/// The frame rates in words.
pub fn rates() -> String {
    let [before @ .., last] = FRAME_RATES;
    let before: Vec<String> = before.iter().map(u32::to_string).collect();
    format!("{} or {last}", before.join(", "))
}

impl Length {
    /// A film of so many seconds, at so many frames a second, that stands still for `pause` seconds at its end.
    ///
    /// # Errors
    ///
    /// Each [`LengthError`], naming the limits.
    pub fn new(seconds: f64, rate: u32, pause: f64) -> Result<Length, LengthError> {
        if !FRAME_RATES.contains(&rate) {
            return Err(LengthError::Rate { rate });
        }
        let valid =
            seconds > 0.0 && seconds <= MOST_SECONDS && (0.0..=MOST_SECONDS).contains(&pause);
        if !valid {
            return Err(LengthError::Seconds);
        }
        let frames = whole(seconds * f64::from(rate)).max(1);
        let pause = whole(pause * f64::from(rate));
        if frames + pause > MOST_FRAMES {
            return Err(LengthError::Frames { frames: (frames + pause).into() });
        }
        Ok(Length { rate, frames, pause })
    }

    /// Frames a second.
    pub fn rate(self) -> u32 {
        self.rate
    }

    /// The frames that differ: the last of them is the finished picture.
    pub fn frames(self) -> u32 {
        self.frames
    }

    /// The frames for which the last one stands still after its own time.
    pub fn pause(self) -> u32 {
        self.pause
    }

    /// The time of a frame in hundredths of a second.
    pub fn hundredths(self) -> u32 {
        100 / self.rate
    }

    /// How long a frame is shown, in frames: the last one stands still.
    pub fn shown(self, frame: u32) -> u32 {
        if frame == self.frames { 1 + self.pause } else { 1 }
    }

    /// The whole film's time in seconds.
    pub fn seconds(self) -> f64 {
        f64::from(self.frames + self.pause) / f64::from(self.rate)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "600 seconds at 50 frames a second at most"
)]
fn whole(frames: f64) -> u32 {
    frames.round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_last_whole_hundredths() {
        for rate in FRAME_RATES {
            let length = Length::new(1.0, rate, 0.0).unwrap();
            assert_eq!(length.hundredths() * rate, 100);
        }
        let problem = Length::new(1.0, 24, 0.0).unwrap_err().to_string();
        assert!(problem.ends_with("choose 1, 2, 4, 5, 10, 20, 25, 50 or 100"), "{problem}");
    }

    #[test]
    fn a_film_has_a_frame_and_not_too_many() {
        assert_eq!(Length::new(1e-9, 25, 0.0).unwrap().frames(), 1);
        for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY, 601.0] {
            assert_eq!(Length::new(seconds, 25, 0.0), Err(LengthError::Seconds), "{seconds}");
            assert_eq!(Length::new(1.0, 25, seconds).is_ok(), seconds == 0.0, "{seconds}");
        }
        assert_eq!(Length::new(600.0, 50, 0.0), Err(LengthError::Frames { frames: 30_000 }));
    }
}
