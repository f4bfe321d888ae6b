//! tmp
use luthier_bake::*;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Instant;
struct O(Mutex<BTreeMap<&'static str, (Instant, f64)>>);
impl Observer for O {
    fn planned(&self, _: usize) {}
    fn finished(&self, _: JobKind) {}
    fn batch(&self, k: JobKind, r: bool) {
        let mut m = self.0.lock().unwrap();
        if r {
            m.insert(k.name(), (Instant::now(), 0.0));
        } else {
            let e = m.get_mut(k.name()).unwrap();
            e.1 = e.0.elapsed().as_secs_f64();
        }
    }
}
fn main() {
    let mut paths: Vec<_> = std::fs::read_dir("materials")
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    let mats: Vec<_> = paths
        .iter()
        .map(|p| {
            luthier_material::parse(p.to_str().unwrap(), &std::fs::read_to_string(p).unwrap(), &|q| {
                std::fs::read_to_string(p.parent().unwrap().join(q))
            })
            .unwrap()
            .material
        })
        .collect();
    let t = Instant::now();
    let o = O(Mutex::default());
    let b = bake(&mats, &|_, _| Err("no".into()), &o).unwrap();
    println!("{:.2}s", t.elapsed().as_secs_f64());
    for (k, v) in o.0.lock().unwrap().iter() {
        println!("  {k} {:.2}", v.1);
    }
    for a in &b.atlases {
        for t in &a.tiles {
            println!(
                "{:?} {} max {:.2e} rms {:.2e} p99 {:.2e} at {:?} ch{} {:.5} {:.5}",
                a.kind,
                t.name,
                t.error.max_abs_err,
                t.error.rms_err,
                t.error.p99_abs_err,
                t.error.worst.at,
                t.error.worst.channel,
                t.error.worst.expected,
                t.error.worst.sampled
            );
        }
    }
}
