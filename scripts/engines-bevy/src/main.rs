//! What another table of the split sum changes in a picture by Bevy.
//!
//! `luthier-engines-bevy FILE`: FILE is a KTX2 of `luthier table dfg --preset bevy`. Balls of metal are drawn in a uniform environment of
//! radiance 1, first with Bevy's own table, then with the file. The pictures are read back as floats and compared with quadrature.

mod expected;
mod scene;

use std::error::Error;
use std::{env, fs};

use expected::{Expected, Light};
use scene::{F0, ROUGHNESSES, Scene};

/// What the sections show: title, light, channel of [`F0`].
const SECTIONS: [(&str, Light, usize); 3] = [
    ("Bevy's map of reflections alone, which is single scattering", Light::Reflected, 0),
    ("Both of Bevy's maps, with its compensation of lost energy", Light::All, 1),
    ("Both of Bevy's maps, where that compensation makes any table white", Light::All, 0),
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [file] = arguments.as_slice() else {
        return Err("usage: luthier-engines-bevy FILE".into());
    };
    let file = fs::read(file)?;
    let mut scene = Scene::new();
    let own = [Light::Reflected, Light::All].map(|light| scene.picture(light));
    scene.replace_table(&file)?;
    let replaced = [Light::Reflected, Light::All].map(|light| scene.picture(light));

    let expected = Expected::new();
    for (title, light, channel) in SECTIONS {
        println!("{title}; f0 = {}\n", F0[channel]);
        println!("| roughness | own table: max | rms | the file: max | rms |\n|---|--:|--:|--:|--:|");
        let balls = (0..ROUGHNESSES.len()).map(Some).chain([None]);
        for ball in balls {
            let name = ball.map_or("all".to_owned(), |ball| ROUGHNESSES[ball].to_string());
            let [own, replaced] = [&own, &replaced].map(|pictures| {
                let picture = &pictures[usize::from(light == Light::All)];
                let difference = expected.compare(picture, channel, light, ball);
                format!("{:.2e} | {:.2e}", difference.max_abs_err, difference.rms_err)
            });
            println!("| {name} | {own} | {replaced} |");
        }
        println!();
    }
    Ok(())
}
