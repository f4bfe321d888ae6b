//! tmp
use luthier_optics::color::*; use luthier_optics::constants::*; use luthier_optics::fresnel::*; use num_complex::Complex64;
type F<'a> = &'a dyn Fn(f64,f64)->f64;
fn lump(nodes: &[WavelengthNode], kept: &[usize]) -> Vec<(f64,[f64;3])> {
    let mut out: Vec<(f64,[f64;3])> = kept.iter().map(|&i|(nodes[i].wavelength_nm,[0.0;3])).collect();
    for n in nodes {
        let r = out.partition_point(|c| c.0 < n.wavelength_nm).clamp(1,out.len()-1);
        let t=(n.wavelength_nm-out[r-1].0)/(out[r].0-out[r-1].0);
        for c in 0..3 { out[r-1].1[c]+=(1.0-t)*n.weight[c]; out[r].1[c]+=t*n.weight[c]; }
    }
    out
}
fn greedy(nodes: &[WavelengthNode], f: F, tol: f64) -> Vec<usize> {
    let last = nodes.len()-1;
    let mut vals: Vec<Vec<f64>> = vec![]; 
    for mu in [1.0,0.5,0.2] { for p in [1,2,3] { vals.push(nodes.iter().map(|n| f(n.wavelength_nm,mu).powi(p)).collect()); } }
    let w: Vec<f64> = nodes.iter().map(|n| n.weight.iter().fold(0f64,|a,b|a.max(b.abs()))).collect();
    let mut kept = vec![0,last];
    loop {
        let mut total = vec![0.0; vals.len()]; let mut worst=(0.0,0);
        for pair in kept.windows(2) { for i in pair[0]+1..pair[1] { let t=(i-pair[0]) as f64/(pair[1]-pair[0]) as f64; let mut e: f64=0.0;
            for (k,v) in vals.iter().enumerate() { let d=(v[i]-(1.0-t)*v[pair[0]]-t*v[pair[1]]).abs()*w[i]; total[k]+=d; e=e.max(d);} if e>worst.0 {worst=(e,i);} } }
        if total.iter().fold(0f64,|a,&b|a.max(b))<tol { return kept; }
        let at=kept.partition_point(|&k|k<worst.1); kept.insert(at,worst.1);
    }
}
fn err(nodes:&[WavelengthNode], set:&[(f64,[f64;3])], f:F)->f64{ let mut w: f64=0.0; for p in [1,2,3] { for i in 0..=20 { let mu = i as f64/20.0; 
       for c in 0..3 { let a: f64 = nodes.iter().map(|n| n.weight[c]*f(n.wavelength_nm,mu).powi(p)).sum(); let b: f64 = set.iter().map(|n| n.1[c]*f(n.0,mu).powi(p)).sum(); w=w.max((a-b).abs()); } } } w }
fn main(){
  let nodes = Color::Spectral.nodes();
  for tol in [2e-4,5e-4,1e-3,2e-3] { println!("tol {tol}"); 
   for d in datasets() { let f=|nm:f64,mu:f64| interface(Complex64::ONE, d.ior.at(nm), mu).unpolarised(); let kept=greedy(&nodes,&f,tol); let e=err(&nodes,&lump(&nodes,&kept),&f); if kept.len()>6 {print!("{} {} {:.1e}; ",d.id,kept.len(),e);} }
   println!();
   for (n,b,nm) in [(1.33,Complex64::ONE,350.0),(1.33,Complex64::ONE,1000.0),(2.3,Complex64::new(2.7,3.7),150.0),(1.5,Complex64::new(1.5,5.7),3000.0),(1.6,Complex64::ONE,10000.0)] { let f=|l:f64,mu:f64| coated(Complex64::ONE,&[FilmLayer{ior:Complex64::new(n,0.0),waves:nm/l}],b,mu).unpolarised(); let kept=greedy(&nodes,&f,tol); 
     let e=err(&nodes,&lump(&nodes,&kept),&f); let two=err(&nodes,&lump(&nodes,&(0..48).map(|i|2*i).filter(|i|*i<nodes.len()).collect::<Vec<_>>()),&f); println!("film {n} {b} {nm}: {} {:.1e} (stride 2: {:.1e})",kept.len(),e,two); }
  }
}
