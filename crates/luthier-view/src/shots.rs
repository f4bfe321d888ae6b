//! Screenshots that the command line asks for.

/// When to take screenshots: the first when the picture is finished, each further one when it is again after files changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shots {
    /// Frames to show before each, at least 1.
    pub frames: u32,
    /// Number of screenshots; the window closes after the last.
    pub count: u32,
}

/// State of the screenshots of [`Shots`].
#[derive(Debug)]
pub(crate) struct Schedule {
    shots: Shots,
    taken: u32,
    frames_left: u32,
    /// Whether there is anything new since the last.
    fresh: bool,
}

impl Schedule {
    pub(crate) fn new(shots: Shots) -> Self {
        Self { shots, taken: 0, frames_left: shots.frames.max(1), fresh: true }
    }

    /// Files changed.
    pub(crate) fn files_changed(&mut self) {
        self.fresh = true;
    }

    /// Counts a frame that was shown. Returns the number of the screenshot to take now, from 1.
    pub(crate) fn frame(&mut self, settled: bool) -> Option<u32> {
        if !settled || !self.fresh || self.taken == self.shots.count {
            self.frames_left = self.shots.frames.max(1);
            return None;
        }
        self.frames_left -= 1;
        if self.frames_left > 0 {
            return None;
        }
        self.frames_left = self.shots.frames.max(1);
        self.fresh = false;
        self.taken += 1;
        Some(self.taken)
    }

    /// Whether screenshot `number` is the last.
    pub(crate) fn is_last(&self, number: u32) -> bool {
        number >= self.shots.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_for_each_change_after_its_frames() {
        let mut schedule = Schedule::new(Shots { frames: 2, count: 2 });
        assert_eq!(schedule.frame(true), None);
        assert_eq!(schedule.frame(false), None, "frames before the picture do not count");
        assert_eq!(schedule.frame(true), None);
        assert_eq!(schedule.frame(true), Some(1));
        assert!((0..5).all(|_| schedule.frame(true).is_none()), "nothing changed");
        schedule.files_changed();
        assert_eq!([schedule.frame(true), schedule.frame(true)], [None, Some(2)]);
        assert!(!schedule.is_last(1) && schedule.is_last(2));
        schedule.files_changed();
        assert!((0..5).all(|_| schedule.frame(true).is_none()), "that was the last");
    }
}
