//! All relations of all simplices of two complexes in flash, on a Cortex-M3: a line for each relation, as `host` prints
//! them, then what the queries took.
//!
//! The image holds neither formatting nor a way to panic: `.ci/small` looks at its symbols.
#![no_std]
#![no_main]

mod console;
mod stack;

use ask::{Line, Memory, ReportError, report};
use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
use sig_core::{Complex, mark_words};

use console::Console;

/// The complexes, files that `sig build` wrote.
static COMPLEXES: [&[u8]; 2] = [
    sig_core::include_aligned!(env!("SIG_SOLID", "the path of a file: .ci/small sets it")),
    sig_core::include_aligned!(env!("SIG_MIXED", "the path of a file: .ci/small sets it")),
];

/// What the queries may take: bits for so many simplices, simplices to visit, simplices of an answer.
const MARKS: usize = mark_words(32_768);
const QUEUE: usize = 192;
const FOUND: usize = 256;

#[entry]
fn main() -> ! {
    static mut MARK_WORDS: [u32; MARKS] = [0; MARKS];
    static mut QUEUE_IDS: [u16; QUEUE] = [0; QUEUE];
    static mut QUEUE_MASKS: [u32; QUEUE] = [0; QUEUE];
    static mut FOUND_IDS: [u16; FOUND] = [0; FOUND];
    let mut memory = Memory { marks: MARK_WORDS, queue: QUEUE_IDS, masks: QUEUE_MASKS, found: FOUND_IDS };
    let mut console = Console::open();
    let outcome = COMPLEXES.iter().try_for_each(|bytes| run(bytes, &mut memory, &mut console));
    console.line(Line::Number("stack", stack::deepest()));
    if let Err(message) = outcome {
        console.text(message);
    }
    loop {
        exit(if outcome.is_ok() { EXIT_SUCCESS } else { EXIT_FAILURE });
    }
}

/// The report of one complex; an error is a message.
fn run(bytes: &'static [u8], memory: &mut Memory<'_, u16>, console: &mut Console) -> Result<(), &'static str> {
    let complex = Complex::<u16>::from_bytes(bytes).map_err(|_| "a file is not a complex of 16-bit indices")?;
    report(&complex, memory, &mut |line| console.line(line)).map_err(|error| match error {
        ReportError::Memory => "the memory is too small",
        ReportError::Growth => "an error asked for the wrong memory, or for too much",
    })
}

/// Never called, and not linked: the compiler sees that nothing panics.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
