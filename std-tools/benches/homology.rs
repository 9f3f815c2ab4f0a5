//! t
use sig_core::with_complex;
use sig_tools::homology::*;
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let file = sig_tools::Mapped::open(&args[0])?;
    let max_dim = args.get(1).map(|d| d.parse().unwrap());
    sig_tools::with_view!(file.view(), complex => {
        let t = std::time::Instant::now();
        let h = homology(&Simplices(&complex), &HomologyOptions { over: Coefficients::Prime(2), max_dim, ..Default::default() })?;
        println!("{:.3} s {:?}", t.elapsed().as_secs_f64(), h);
    });
    let status = std::fs::read_to_string("/proc/self/status")?;
    println!("{}", status.lines().find(|l| l.starts_with("VmHWM")).unwrap());
    Ok(())
}
