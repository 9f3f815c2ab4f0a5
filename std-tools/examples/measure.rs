#![allow(missing_docs, clippy::all, clippy::pedantic)]
use sig_tools::build::*;
use sig_tools::soup::*;
use std::sync::Mutex;
use std::time::Instant;
fn grid(k: u32, l: u32, m: u32) -> Soup {
    let mut soup = Soup::new(Labels::Numbered((k * l * m) as usize), true);
    let steps = [l * m, m, 1];
    for x in 0..k - 1 {
        for y in 0..l - 1 {
            for z in 0..m - 1 {
                let corner = x * steps[0] + y * steps[1] + z;
                for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
                    soup.push(&[corner, one, two, two + steps[c]]);
                }
            }
        }
    }
    soup
}
fn hwm() -> u64 {
    std::fs::read_to_string("/proc/self/status")
        .unwrap()
        .lines()
        .find(|l| l.starts_with("VmHWM"))
        .unwrap()
        .split_whitespace()
        .nth(1)
        .unwrap()
        .parse::<u64>()
        .unwrap()
        * 1024
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let threads: usize = args[2].parse().unwrap();
    let order = match args.get(3).map(String::as_str) {
        Some("hilbert") => VertexOrder::Hilbert,
        Some("rcm") => VertexOrder::Rcm,
        _ => VertexOrder::Input,
    };
    let rounds: usize = args.get(4).map_or(3, |r| r.parse().unwrap());
    let soup = if let Ok(k) = args[1].parse::<u32>() {
        grid(k, k, k)
    } else {
        let b = std::fs::read(&args[1]).unwrap();
        let u = |i: usize| u32::from_le_bytes(b[i..i + 4].try_into().unwrap());
        let (nv, nt) = (u(4) as usize, u(8) as usize);
        let mut s = Soup::new(Labels::Numbered(nv), true);
        s.coordinates = Some(Coordinates {
            dim: 3,
            values: Scalars::F32((0..3 * nv).map(|i| f32::from_bits(u(12 + 4 * i))).collect()),
        });
        s.simplices = vec![vec![], vec![], vec![], (0..4 * nt).map(|i| u(12 + 12 * nv + 4 * i)).collect()];
        s
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let base = hwm();
    for round in 0..rounds {
        let s = soup.clone();
        let log = Mutex::new(Vec::<(Phase, Instant)>::new());
        let progress = |phase: Phase, _done: u64, _total: u64| {
            let now = Instant::now();
            let mut l = log.lock().unwrap();
            match l.last_mut() {
                Some(e) if e.0 == phase => e.1 = now,
                _ => l.push((phase, now)),
            }
        };
        let t = Instant::now();
        let b = pool
            .install(|| build(s, &BuildOptions { order, progress: Some(&progress), ..Default::default() }))
            .unwrap();
        let e = t.elapsed();
        let Arrays::Narrow(a) = &b.arrays else { panic!() };
        let n = a.num_simplices;
        let out = 4
            * (a.boundary.len() + a.pointers.len() + a.lists.len() + a.child_offsets.len() + a.last_vertices.len())
            + a.flags.len()
            + b.parity.len()
            + b.coordinates.as_ref().map_or(0, |_| 12 * a.first[1]);
        let fl: u32 = a.flags.iter().map(|f| f.count_ones()).sum();
        let mut prev = t;
        let mut ph = String::new();
        for (p, at) in log.lock().unwrap().iter() {
            ph += &format!(" ..{p:?} {:.1}", (*at - prev).as_secs_f64() * 1e9 / n as f64);
            prev = *at;
        }
        ph += &format!(" rest {:.1}", (t + e - prev).as_secs_f64() * 1e9 / n as f64);
        println!(
            "{} thr {threads} n {n} {:.3}s {:.1} ns/simplex | peak/out {:.2} (base {:.2}) flagged {:.3} |{ph}",
            args[1],
            e.as_secs_f64(),
            e.as_secs_f64() * 1e9 / n as f64,
            hwm() as f64 / out as f64,
            base as f64 / out as f64,
            fl as f64 / a.first[3] as f64
        );
        let _ = round;
    }
}
