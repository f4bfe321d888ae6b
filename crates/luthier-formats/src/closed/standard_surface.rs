//! Numbers of Standard Surface.

use luthier_import::Fate::{Approximated, ClosedForm, Kept};
use luthier_import::Line;
use luthier_layers::engines::standard_surface::artistic;
use luthier_optics::Rgb;
use luthier_optics::fresnel::interface;
use luthier_optics::schlick::{F82, F82_COS_THETA, index_of_f0};

use super::{
    Closed, FILM_ON_METAL, FITTED_BELOW_FILM, IN_THE_COLOR, film, held, hue, lengthwise, most, say, say_slopes,
    transmittance, widened,
};
use crate::fit::Free;
use crate::numbers::{Coat, Numbers};
use crate::surface::{Base, Slopes, Surface};

const SLOPES: &str = "alpha = r^2 over and times sqrt(1 - a), turned round";

/// The greatest anisotropy, beyond which the format holds it.
const ANISOTROPY_MAX: f64 = 0.98;

pub(super) fn closed(surface: &Surface) -> Closed {
    let mut numbers = Numbers::plain();
    let (mut free, mut lines) = (Vec::new(), Vec::new());
    let mut coat = surface.coat;
    let mut is_matte = false;
    match &surface.base {
        Base::Stated(stated, sigma) => {
            numbers.base_color = stated.base_color;
            numbers.metallic = stated.metallic;
            say(&mut lines, "base: colour, metal", Kept, "");
            if stated.metallic < 1.0 {
                reflectance(&mut numbers, &mut lines, stated.dielectric);
                diffuse(&mut numbers, &mut lines, *sigma);
            }
            if stated.metallic > 0.0 {
                let curves = [0, 1, 2].map(|c: usize| F82 { f0: stated.base_color[c], tint: stated.f82_tint[c] });
                edge(&mut numbers, &mut lines, curves);
            }
        }
        Base::Metal(curves) => {
            numbers.metallic = 1.0;
            numbers.base_color = held(&mut lines, curves.map(|curve| curve.f0));
            edge(&mut numbers, &mut lines, *curves);
            say(&mut lines, "base: index", ClosedForm, "its reflectance along the normal and at 82 degrees");
            if surface.film.is_some() {
                free.push(Free::Color);
                say(&mut lines, FILM_ON_METAL, Approximated, FITTED_BELOW_FILM);
            }
        }
        Base::Plastic(plastic) => {
            numbers.base_color = plastic.diffuse.albedo;
            if coat.is_none() && plastic.is_coat() {
                coat = Some(plastic.as_coat(surface.slopes));
                (numbers.specular, is_matte) = (0.0, true);
                say(&mut lines, "base: albedo", Kept, "below a coat, in place of a dielectric of its own");
            } else {
                reflectance(&mut numbers, &mut lines, plastic.f0);
                if plastic.absorbs() {
                    say(&mut lines, "base: absorption", Approximated, IN_THE_COLOR);
                }
                numbers.base_color = numbers.base_color.map(|r| (r * r).min(1.0));
                free.push(Free::Color);
                say(&mut lines, "base: albedo", Approximated, "the colour that shows, fitted over angles");
            }
            diffuse(&mut numbers, &mut lines, plastic.diffuse.sigma);
        }
        Base::Matte(of) => {
            numbers.base_color = of.albedo;
            (numbers.specular, is_matte) = (0.0, true);
            say(&mut lines, "base: albedo", Kept, "");
            diffuse(&mut numbers, &mut lines, of.sigma);
        }
        Base::Black(f0) => {
            numbers.base_color = [0.0; 3];
            // A film of an index reflects on what reflects nothing itself.
            numbers.ior = if surface.film.is_some() { 1.0 } else { numbers.ior };
            reflectance(&mut numbers, &mut lines, *f0);
            say(&mut lines, "what lies below", Approximated, "light that goes through is lost: the base is black");
        }
    }
    let mut frees_rough = false;
    if is_matte {
        numbers.roughness = 1.0;
    } else {
        frees_rough = say_slopes(&mut lines, "base", &surface.slopes, SLOPES);
        [numbers.roughness, numbers.anisotropy, numbers.turn] = facets(&surface.slopes);
    }
    if let Some(coat) = &coat {
        if say_slopes(&mut lines, "coat", &coat.slopes, SLOPES) {
            free.push(Free::CoatRoughness);
        }
        let [roughness, anisotropy, turn] = facets(&coat.slopes);
        say(&mut lines, "coat: index, weight", Kept, "");
        if coat.depth != [0.0; 3] {
            say(
                &mut lines,
                "coat: absorption",
                ClosedForm,
                "coat_color is what goes through it and back along the normal; here at all angles alike",
            );
        }
        if coat.darkens {
            let note = "light that goes to and fro below the coat, and refraction, are in colour and roughness of the base, fitted";
            say(&mut lines, "base below the coat", Approximated, note);
            if !free.contains(&Free::Color) {
                free.push(Free::Color);
            }
            if !is_matte && most(numbers.specular_color) > 0.0 {
                numbers.roughness = widened(numbers.roughness * numbers.roughness, coat).sqrt();
                frees_rough = true;
            }
        } else {
            say(&mut lines, "coat: darkening", Kept, "the base is as bright as its colour");
        }
        let color = transmittance(coat.depth);
        let (weight, ior) = (coat.weight, coat.ior);
        numbers.coat = Some(Coat { weight, color, roughness, anisotropy, turn, ior, darkens: false });
    }
    if frees_rough {
        free.push(Free::Roughness);
    }
    numbers.film = film(&mut lines, surface.film.as_ref());
    if numbers.film.as_ref().is_some_and(|film| film.weight < 1.0) {
        say(&mut lines, "film: weight", Approximated, "films cover all of the surface here");
        numbers.film.iter_mut().for_each(|film| film.weight = 1.0);
    }
    Closed { numbers, free, lines }
}

/// Roughness, anisotropy and turn.
pub(super) fn facets(slopes: &Slopes) -> [f64; 3] {
    let ([along, across], turn) = lengthwise(slopes);
    if along <= across {
        return [along.sqrt(), 0.0, 0.0];
    }
    [(along * across).sqrt().sqrt(), (1.0 - across / along).min(ANISOTROPY_MAX), turn]
}

fn diffuse(numbers: &mut Numbers, lines: &mut Vec<Line>, sigma: f64) {
    if sigma > 0.0 {
        numbers.diffuse_roughness = sigma;
        say(lines, "base: sigma", Kept, "");
    }
}

fn reflectance(numbers: &mut Numbers, lines: &mut Vec<Line>, f0: Rgb) {
    let (color, most) = hue(f0);
    if most == 0.0 {
        numbers.specular = if numbers.ior == 1.0 { 1.0 } else { 0.0 };
        return;
    }
    numbers.specular_color = color;
    numbers.ior = index_of_f0(most.min(0.99));
    say(lines, "base: F0", ClosedForm, "specular_IOR of (1 + sqrt F0)/(1 - sqrt F0), and its hue as specular_color");
}

/// The colour of the edge of Gulbrandsen's metal that reflects as much at 82 degrees.
fn edge(numbers: &mut Numbers, lines: &mut Vec<Line>, curves: [F82; 3]) {
    numbers.specular_color = curves.map(edge_of);
    say(
        lines,
        "base: edge of the metal",
        ClosedForm,
        "specular_color with which the format reflects as much at 82 degrees",
    );
}

fn edge_of(curve: F82) -> f64 {
    let wanted = curve.eval(F82_COS_THETA);
    let air = luthier_layers::num_complex::Complex64::new(1.0, 0.0);
    let found = |edge: f64| interface(air, artistic(curve.f0, edge), F82_COS_THETA).unpolarised();
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if found(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
