//! The command `sig`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
