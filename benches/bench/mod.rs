//! Medians of times. A benchmark is a name of a group and what is timed; `cargo bench` repeats it
//! for a second and writes its median to `target/benches/GROUP/NAME/estimate.json`, where
//! `benches/table` finds it. In any other way (`cargo test --bench`) each is run once.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Samples of one benchmark, and the time that all of them together take.
const SAMPLES: usize = 20;
const TIME: Duration = Duration::from_millis(1200);

/// Benchmarks of one name.
pub struct Group {
    name: &'static str,
    /// What one call does: steps, speeds or cells; 0 is not told.
    pub count: u64,
}

pub fn benchmark_group(name: &'static str) -> Group {
    Group { name, count: 0 }
}

impl Group {
    /// Times calls of `timed`.
    pub fn bench<T>(&mut self, name: &str, mut timed: impl FnMut() -> T) {
        let mut seconds = |calls: u32| {
            let began = Instant::now();
            (0..calls).for_each(|_| _ = black_box(timed()));
            began.elapsed().as_secs_f64() / f64::from(calls)
        };
        let once = seconds(1);
        if !std::env::args().any(|word| word == "--bench") {
            return;
        }
        let calls = (TIME.as_secs_f64() / SAMPLES as f64 / once).clamp(1.0, 1e6) as u32;
        let mut all: Vec<f64> = (0..SAMPLES).map(|_| seconds(calls)).collect();
        all.sort_by(f64::total_cmp);
        let median = 0.5 * (all[SAMPLES / 2 - 1] + all[SAMPLES / 2]);
        let Self { name: group, count } = self;
        println!("{group}/{name}: {median:.4e} s ({:.4e} to {:.4e})", all[0], all[SAMPLES - 1]);
        let target = std::env::var("CARGO_TARGET_DIR").unwrap_or_else(|_| "target".into());
        let folder = Path::new(&target).join("benches").join(group).join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let estimate = format!("{{\"median_s\": {median:e}, \"count\": {count}}}\n");
        std::fs::write(folder.join("estimate.json"), estimate).unwrap();
    }
}
