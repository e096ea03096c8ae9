use rubscope::motion::Motion;
use rubscope::scene::Scene;
fn main() {
    let mut s = Scene::builtin("paper-nd3").unwrap();
    s.solver.end_s = 0.5;
    let t = std::time::Instant::now();
    let mut m = Motion::new(&s);
    m.advance(0.5).unwrap();
    println!("{:?} ns/step {}", m.state().u, t.elapsed().as_nanos() as f64 / 5e6);
}
