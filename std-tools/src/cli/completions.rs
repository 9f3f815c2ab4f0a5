//! `sig completions`: what a shell needs to complete the command line.

use clap_complete::Shell;

use super::output;

/// Print completions of the command line for a shell
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig completions bash > ~/.local/share/bash-completion/completions/sig
  sig completions zsh > ~/.zfunc/_sig")]
pub(super) struct Args {
    /// The shell
    shell: Shell,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        // Into memory first: the generator panics where it cannot write.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut super::command(), "sig", &mut script);
        Ok(output::stdout(|out| out.write_all(&script))?)
    }
}
