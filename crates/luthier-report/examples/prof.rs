use luthier_report::stability::*;
fn main() {
    let cases = cases();
    let t = std::time::Instant::now();
    let cells = model_cells(&cases, &|| {});
    for c in cells.iter().filter(|c| c.verdict != Verdict::Holds) {
        println!("{} {} {:?} {:.3e}", c.method, c.case, c.fault, c.error);
    }
    eprintln!("all {:?} {} cells", t.elapsed(), cells.len());
}
