//! The remaining time of a run, estimated from its progress, and the message about a long run.

use super::args::{MethodArg, RenderArgs};
use bothways::orders::Order;
use bothways::progress::{Progress, Stage};
use std::time::Duration;

/// A run with a longer expected time gets a message.
const LONG: Duration = Duration::from_secs(60);
/// The shortest time that is enough for an estimate.
const ENOUGH: Duration = Duration::from_secs(2);

/// The known pace of a run. All times start at the beginning of the run.
#[derive(Debug, Default)]
pub(super) struct Forecast {
    /// The number of orders after the present order; the forecast expects the same time for each.
    later: u32,
    order: Option<Order>,
    /// The time at which the order's first frame began.
    begun: Duration,
    /// The time of the last step, the number of steps done by then, and the number of all steps.
    last: Option<(Duration, u64, u64)>,
    said: bool,
}

impl Forecast {
    /// The forecast of a run with this number of orders.
    pub(super) fn new(orders: usize) -> Forecast {
        Forecast { later: u32::try_from(orders).unwrap_or(1), ..Forecast::default() }
    }

    /// Stores the progress at time `now`. The first time that the forecast makes the run a long one, this function
    /// returns the time of the whole run.
    pub(super) fn note(&mut self, progress: Progress, now: Duration) -> Option<Duration> {
        let Progress { order, stage, done, total } = progress;
        if self.order != Some(order) {
            (self.order, self.later) = (Some(order), self.later.saturating_sub(1));
        }
        if stage == Stage::Preparing || done == 0 {
            (self.begun, self.last) = (now, None);
            return None;
        }
        // Threads report their steps in any order.
        if self.last.is_none_or(|(_, most, _)| done > most) {
            self.last = Some((now, done, total));
        }
        let whole = now + self.left(now).filter(|_| now - self.begun >= ENOUGH)?;
        if self.said || whole < LONG {
            return None;
        }
        self.said = true;
        Some(whole)
    }

    /// The remaining time of the run from `now` on, if there is enough data.
    pub(super) fn left(&self, now: Duration) -> Option<Duration> {
        let (at, done, total) = self.last?;
        let order = seconds_of_all(at.checked_sub(self.begun)?, done, total);
        let all = order * f64::from(1 + self.later) + self.begun.as_secs_f64();
        Some(Duration::try_from_secs_f64(all).unwrap_or(Duration::MAX).saturating_sub(now))
    }
}

/// The time of all steps at the pace of the steps done.
#[expect(clippy::cast_precision_loss, reason = "an estimate")]
fn seconds_of_all(time: Duration, done: u64, total: u64) -> f64 {
    time.as_secs_f64() * total as f64 / done as f64
}

/// The message about a run of this length.
pub(super) fn advice(whole: Duration, args: &RenderArgs) -> String {
    let method = &args.method;
    let (why, first) = match (method.method, method.repeat) {
        (MethodArg::Textbook, _) => (
            ", as the textbook tests every primitive at every sample",
            "--method fast gives the same answers far sooner, ",
        ),
        (MethodArg::Fast, Some(_)) => ("", "a smaller --repeat shortens it, "),
        (MethodArg::Fast, None) if method.stream && !args.output.no_times => {
            ("", "--no-times reads the file once less, ")
        }
        (MethodArg::Fast, None) => ("", ""),
    };
    let more = if first.is_empty() { "" } else { "too" };
    let rest = format!("a smaller --size, a --crop of it or fewer --samples shorten it {more}");
    format!("this takes about {}{why}: {first}{}", words(whole), rest.trim_end())
}

/// A time in words, less exact for longer times.
pub(super) fn words(time: Duration) -> String {
    let seconds = time.as_secs_f64().ceil();
    let [minutes, hours] = [60.0, 3600.0].map(|unit| (seconds / unit).round());
    let days = (seconds / 86400.0).round();
    if seconds < 90.0 {
        format!("{seconds} s")
    } else if minutes < 90.0 {
        format!("{minutes} min")
    } else if hours < 48.0 {
        format!("{hours} h")
    } else {
        format!("{days} days")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(order: Order, done: u64) -> Progress {
        Progress { order, stage: Stage::Rendering, done, total: 100 }
    }

    const S: fn(u64) -> Duration = Duration::from_secs;

    #[test]
    fn what_is_done_tells_of_the_rest_and_of_the_other_order() {
        let mut forecast = Forecast::new(2);
        assert_eq!(forecast.left(S(1)), None);
        forecast.note(at(Order::Object, 0), S(1));
        assert_eq!(forecast.note(at(Order::Object, 10), S(3)), None);
        // 20 seconds for each step, from the first step on.
        assert_eq!(forecast.left(S(3)), Some(S(38)));
        assert_eq!(forecast.left(S(5)), Some(S(36)));
        forecast.note(at(Order::Image, 0), S(21));
        assert_eq!(forecast.left(S(22)), None);
        forecast.note(at(Order::Image, 50), S(31));
        assert_eq!(forecast.left(S(31)), Some(S(10)));
        assert_eq!(forecast.left(S(99)), Some(S(0)));
    }

    #[test]
    fn a_long_run_is_told_of_once_and_not_too_early() {
        let mut forecast = Forecast::new(1);
        forecast.note(at(Order::Object, 0), S(0));
        let early = Duration::from_millis(1900);
        assert_eq!(forecast.note(at(Order::Object, 1), early), None);
        assert_eq!(forecast.note(at(Order::Object, 2), S(3)), Some(S(150)));
        assert_eq!(forecast.note(at(Order::Object, 3), S(5)), None);
        let mut forecast = Forecast::new(1);
        forecast.note(at(Order::Object, 0), S(0));
        assert_eq!(forecast.note(at(Order::Object, 10), S(5)), None);
    }

    #[test]
    fn times_are_said_as_people_say_them() {
        let cases = [
            (0.2, "1 s"),
            (89.0, "89 s"),
            (91.0, "2 min"),
            (3600.0, "60 min"),
            (5.0 * 3600.0, "5 h"),
            (1e6, "12 days"),
        ];
        for (seconds, expected) in cases {
            assert_eq!(words(Duration::from_secs_f64(seconds)), expected);
        }
    }
}
