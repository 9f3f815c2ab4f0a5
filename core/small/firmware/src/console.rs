//! Lines to the debugger, without `core::fmt`.

use ask::Line;
use cortex_m_semihosting::hio::{HostStream, hstdout};

/// The standard output of the host.
pub(crate) struct Console {
    /// None where there is no debugger: then nothing is printed.
    stream: Option<HostStream>,
}

impl Console {
    pub(crate) fn open() -> Self {
        Self { stream: hstdout().ok() }
    }

    /// A line of text.
    pub(crate) fn text(&mut self, text: &str) {
        self.write(text.as_bytes());
        self.write(b"\n");
    }

    /// A line of a report: numbers in decimal, checksums as eight hexadecimal digits.
    pub(crate) fn line(&mut self, line: Line) {
        match line {
            Line::Number(name, count) => self.number(name, count),
            Line::Summary(name, summary) => {
                self.number(name, summary.count as usize);
                self.checksum(summary.checksum);
            }
            Line::Grown(name, errors, summary) => {
                self.write(b"grown ");
                self.number(name, errors as usize);
                self.write(b" ");
                self.digits(summary.count as usize, 10, 1);
                self.checksum(summary.checksum);
            }
        }
        self.write(b"\n");
    }

    fn number(&mut self, name: &str, value: usize) {
        self.write(name.as_bytes());
        self.write(b" ");
        self.digits(value, 10, 1);
    }

    fn checksum(&mut self, checksum: u32) {
        self.write(b" ");
        self.digits(checksum as usize, 16, 8);
    }

    fn digits(&mut self, mut value: usize, base: usize, least: usize) {
        let mut digits = [b'0'; 10];
        let mut len = 0;
        for slot in digits.iter_mut().rev() {
            if value == 0 && len >= least {
                break;
            }
            let digit = u8::try_from(value % base).unwrap_or(0);
            *slot = if digit < 10 { b'0' + digit } else { b'a' + (digit - 10) };
            value /= base;
            len += 1;
        }
        self.write(digits.get(digits.len() - len..).unwrap_or_default());
    }

    fn write(&mut self, bytes: &[u8]) {
        // There is nobody to tell that nothing can be told.
        let _ = self.stream.as_mut().map(|stream| stream.write_all(bytes));
    }
}
