//! A run of a command: its output, and how it ended.

use serde_json::Value;

/// Output of a command, and how it ended.
#[derive(Debug)]
pub struct Run {
    pub(crate) command: String,
    /// Exit code; `None` where a signal ended it.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Run {
    /// A run that was started by other means, and said nothing on standard output.
    pub fn ended(command: &str, code: Option<i32>, stderr: String) -> Self {
        Self { command: command.to_owned(), code, stdout: String::new(), stderr }
    }

    /// Exit code as expected.
    #[track_caller]
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}\n{}{}", self.command, self.stdout, self.stderr);
        self
    }

    /// Refused with one error, without a word on standard output.
    #[track_caller]
    pub fn fails(self, code: i32, parts: &[&str]) -> Self {
        let run = self.exits(code);
        assert_eq!(run.stdout, "", "{}", run.command);
        let errors = run.errors();
        assert_eq!(errors.len(), 1, "{}\n{}", run.command, run.stderr);
        for part in parts {
            assert!(errors[0].contains(part), "{}\nno `{part}` in\n{}", run.command, run.stderr);
        }
        run
    }

    /// Lines that begin an error, but for the one that drivers of a machine without a desktop print.
    pub fn errors(&self) -> Vec<&str> {
        let errors = self.stderr.lines().filter(|line| line.starts_with("error: "));
        errors.filter(|line| !line.contains("XDG_RUNTIME_DIR")).collect()
    }

    /// Standard error with some parts in it.
    #[track_caller]
    pub fn says(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.stderr.contains(part), "{}\nno `{part}` in\n{}", self.command, self.stderr);
        }
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }

    /// Whether the command ended for want of a graphics adapter. On a build server there must be one.
    pub fn lacks_adapter(&self) -> bool {
        self.lacks("mesa-vulkan-drivers")
    }

    /// Whether the command ended for want of RADV, which compiles for chips that are not there. On a build server there must be one.
    pub fn lacks_driver(&self) -> bool {
        self.lacks("RADV")
    }

    fn lacks(&self, part: &str) -> bool {
        let lacks = self.code == Some(4) && self.stderr.contains(part);
        if lacks {
            assert!(std::env::var_os("CI").is_none(), "{}", self.stderr);
            eprintln!("skipped: {}", self.stderr.trim_end());
        }
        lacks
    }

    /// The error of a command that was asked for JSON: the one object on standard output, in which the sentence on standard error is.
    #[track_caller]
    pub fn told_error(self, code: i32, kind: &str) -> Value {
        let run = self.exits(code);
        let object = run.json();
        let (error, command) = (&object["error"], &run.command);
        assert_eq!((&error["code"], &error["kind"]), (&Value::from(code), &Value::from(kind)), "{command}: {object}");
        assert_eq!(object.as_object().unwrap().len(), 1, "{object}");
        let message = error["message"].as_str().unwrap();
        // Behind the diagnostics, which begin in the same way.
        let sentence = run.errors().last().copied().unwrap_or_default().to_owned();
        assert!(!message.is_empty() && sentence.contains(message), "{command}: {message}\n{}", run.stderr);
        error.clone()
    }
}
