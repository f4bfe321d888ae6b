//! Waiting for a program by the work that it does: machines differ, and are shared.

use std::fs;
use std::time::Duration;

/// Pause between two looks.
pub const LOOK: Duration = Duration::from_millis(50);

/// Processor time in ticks of 10 ms, an hour: ten times what anything in these tests takes from one sign of progress to the next.
/// A smaller limit would fail good programs on slow processors; a larger one only delays the news of an endless loop.
const WORK_MAX: u64 = 360_000;

/// Looks at which no thread of a program wanted a processor, ten minutes of sleep: programs in these tests sleep for moments.
const ASLEEP_MAX: u32 = 12_000;

/// How long a test still waits for a program and its descendants.
///
/// Two things are counted since the last sign of progress: the processor time that they used, and the looks at which all of their threads
/// slept. Neither grows while they wait for a processor or a disk, so that a busy machine ends no wait. Both are read from Linux' `/proc`;
/// elsewhere a wait has no end.
#[derive(Debug)]
pub struct Patience {
    process: u32,
    work_max: u64,
    asleep_max: u32,
    /// Processor time at the last sign of progress.
    before: u64,
    asleep: u32,
}

impl Patience {
    /// Patience with a running process.
    pub fn with(process: u32) -> Self {
        Self::within(process, WORK_MAX, ASLEEP_MAX)
    }

    fn within(process: u32, work_max: u64, asleep_max: u32) -> Self {
        let mut patience = Self { process, work_max, asleep_max, before: 0, asleep: 0 };
        patience.progress();
        patience
    }

    /// The program got on: counts from here.
    pub fn progress(&mut self) {
        self.before = Seen::of(self.process).ticks;
        self.asleep = 0;
    }

    /// Looks at the program.
    ///
    /// # Errors
    ///
    /// The work or the sleep of the program, once it is too much without progress.
    pub fn look(&mut self) -> Result<(), String> {
        let seen = Seen::of(self.process);
        let work = seen.ticks.saturating_sub(self.before);
        self.asleep += u32::from(seen.is_asleep);
        if work > self.work_max {
            return Err(format!("{} s of processor time without progress", work / 100));
        }
        if self.asleep > self.asleep_max {
            return Err(format!("asleep at {} looks, without progress", self.asleep));
        }
        Ok(())
    }

    /// Pauses, then looks.
    ///
    /// # Panics
    ///
    /// Once the program did too much in place of what is waited for.
    #[track_caller]
    pub fn wait_for(&mut self, what: &str) {
        std::thread::sleep(LOOK);
        if let Err(did) = self.look() {
            panic!("no {what}: {did}");
        }
    }
}

/// A process and its descendants at one look.
struct Seen {
    /// Processor time of all, also of those that have ended, in ticks of 10 ms.
    ticks: u64,
    /// Whether every thread sleeps.
    is_asleep: bool,
}

impl Seen {
    fn of(process: u32) -> Self {
        let mut seen = Self { ticks: 0, is_asleep: true };
        seen.is_asleep = seen.add(process) && seen.is_asleep;
        seen
    }

    /// Adds a process; whether there is one.
    fn add(&mut self, process: u32) -> bool {
        let Some(fields) = fields(&format!("/proc/{process}/stat")) else { return false };
        // Of itself and of children that have ended, each in user and system mode: proc(5).
        self.ticks += fields[11..15].iter().map(|field| field.parse::<u64>().unwrap_or(0)).sum::<u64>();
        for task in fs::read_dir(format!("/proc/{process}/task")).into_iter().flatten().flatten() {
            let folder = task.path().display().to_string();
            let state = self::fields(&format!("{folder}/stat")).map(|fields| fields[0].clone());
            self.is_asleep &= state.is_none_or(|state| ["S", "I", "Z", "X"].contains(&state.as_str()));
            for child in fs::read_to_string(format!("{folder}/children")).unwrap_or_default().split_whitespace() {
                self.add(child.parse().unwrap());
            }
        }
        true
    }
}

/// Fields of a `stat` file behind the name of the program, which may have spaces.
fn fields(path: &str) -> Option<Vec<String>> {
    let text = fs::read_to_string(path).ok()?;
    let (_, rest) = text.rsplit_once(')')?;
    Some(rest.split_whitespace().map(str::to_owned).collect())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::process::{Child, Command};

    use super::*;

    struct Shell(Child);

    impl Shell {
        fn run(script: &str) -> Self {
            Self(Command::new("sh").args(["-c", script]).spawn().unwrap())
        }

        fn signal(&self, name: &str) {
            assert!(Command::new("kill").args([name, &self.0.id().to_string()]).status().unwrap().success());
        }
    }

    impl Drop for Shell {
        fn drop(&mut self) {
            self.0.kill().unwrap();
            self.0.wait().unwrap();
        }
    }

    /// Looks until patience ends.
    fn end(patience: &mut Patience) -> String {
        loop {
            std::thread::sleep(LOOK);
            if let Err(did) = patience.look() {
                return did;
            }
        }
    }

    #[test]
    fn a_loop_without_end_is_told_by_its_work() {
        // In a child of the process that is looked at, which a failed test does not leave running.
        let mut busy =
            Shell::run("(i=0; while [ $i -lt 9000000 ]; do i=$((i + 1)); done) & trap 'kill $!; exit' TERM; wait");
        assert!(end(&mut Patience::within(busy.0.id(), 20, u32::MAX)).contains("processor time"));
        busy.signal("-TERM");
        busy.0.wait().unwrap();
    }

    #[test]
    fn a_program_that_sleeps_is_told_by_looks() {
        let idle = Shell::run("exec sleep 100000");
        assert!(end(&mut Patience::within(idle.0.id(), u64::MAX, 5)).contains("asleep at 6 looks"));
    }

    /// A program that is stopped gets no processor, as one on a machine that is too busy.
    #[test]
    fn a_program_that_gets_no_processor_costs_no_patience() {
        let busy = Shell::run("while :; do :; done");
        busy.signal("-STOP");
        let mut patience = Patience::within(busy.0.id(), 20, 5);
        for _ in 0..12 {
            std::thread::sleep(LOOK);
            assert_eq!(patience.look(), Ok(()));
        }
        busy.signal("-CONT");
        assert!(end(&mut patience).contains("processor time"));
    }

    #[test]
    fn progress_begins_anew() {
        let idle = Shell::run("exec sleep 100000");
        let mut patience = Patience::within(idle.0.id(), u64::MAX, 3);
        for _ in 0..12 {
            std::thread::sleep(LOOK);
            patience.progress();
            assert_eq!(patience.look(), Ok(()));
        }
    }
}
