//! Numbers of glTF 2.0.

use luthier_import::Fate::{Approximated, ClosedForm, Dropped, Kept};
use luthier_import::Line;
use luthier_optics::Rgb;
use luthier_optics::schlick::index_of_f0;

use super::{Closed, IN_THE_COLOR, film, held, hue, lengthwise, most, say, say_slopes, widened};
use crate::fit::Free;
use crate::formula::f0_of;
use crate::numbers::{Coat, Numbers};
use crate::surface::{self, Base, Slopes, Surface};

/// Index of coats of the format, and of its dielectrics where none is named.
const IOR: f64 = 1.5;

/// Index from which F0 is a colour rather than an index.
const IOR_MAX: f64 = 5.0;

const SLOPES: &str = "roughness is the root of alpha; anisotropy the root of (alpha_x - alpha_y)/(1 - alpha_y)";

pub(super) fn closed(surface: &Surface) -> Closed {
    let mut numbers = Numbers::plain();
    let (mut free, mut lines) = (Vec::new(), Vec::new());
    let mut coat = surface.coat;
    let mut frees_rough = say_slopes(&mut lines, "base", &surface.slopes, SLOPES);
    match &surface.base {
        Base::Stated(stated, sigma) => {
            numbers.base_color = stated.base_color;
            numbers.metallic = stated.metallic;
            say(&mut lines, "base: colour, metal", Kept, "");
            if stated.metallic < 1.0 {
                reflectance(&mut numbers, &mut lines, stated.dielectric);
                diffuse(&mut lines, *sigma);
            }
            if stated.metallic > 0.0 && stated.f82_tint != [1.0; 3] {
                say(&mut lines, "base: f82_tint", Dropped, "metals are as bright at their edge as Schlick's formula");
            }
        }
        Base::Metal(curves) => {
            numbers.metallic = 1.0;
            numbers.base_color = held(&mut lines, curves.map(|curve| curve.f0));
            free.push(Free::Color);
            let note =
                "the index is a colour, fitted over angles; metals are as bright at their edge as Schlick's formula";
            say(&mut lines, "base: index", Approximated, note);
        }
        Base::Plastic(plastic) => {
            if plastic.weight < 1.0 {
                // A coat that is not everywhere, over a base that reflects nothing.
                coat = Some(plastic.as_coat(surface.slopes));
                numbers.specular = 0.0;
                frees_rough = false;
            } else {
                reflectance(&mut numbers, &mut lines, plastic.f0);
                if plastic.absorbs() {
                    say(&mut lines, "base: absorption", Approximated, IN_THE_COLOR);
                }
            }
            numbers.base_color = plastic.diffuse.albedo.map(|r| (r * r).min(1.0));
            free.push(Free::Color);
            say(&mut lines, "base: albedo", Approximated, "the colour that shows, fitted over angles");
            diffuse(&mut lines, plastic.diffuse.sigma);
        }
        Base::Matte(of) => {
            numbers.base_color = of.albedo;
            numbers.specular = 0.0;
            numbers.roughness = 1.0;
            say(&mut lines, "base: albedo", Kept, "");
            diffuse(&mut lines, of.sigma);
        }
        Base::Black(f0) => {
            numbers.base_color = [0.0; 3];
            reflectance(&mut numbers, &mut lines, *f0);
            say(&mut lines, "what lies below", Approximated, "light that goes through is lost: the base is black");
        }
    }
    if !matches!(surface.base, Base::Matte(_)) && numbers.specular > 0.0 {
        [numbers.roughness, numbers.anisotropy, numbers.turn] = facets(&surface.slopes);
    }
    if let Some(coat) = &coat {
        numbers.coat = Some(coated(coat, &mut numbers, &mut free, &mut lines, &mut frees_rough));
    }
    if frees_rough && numbers.specular > 0.0 {
        free.push(Free::Roughness);
    }
    numbers.film = film(&mut lines, surface.film.as_ref());
    if let Some(film) = &numbers.film
        && matches!(surface.base, Base::Metal(_))
    {
        say(
            &mut lines,
            "film on a metal by its index",
            Approximated,
            format!("films of index {} lie on an F0 here", film.ior),
        );
    }
    Closed { numbers, free, lines }
}

/// Roughness, anisotropy and turn.
pub(super) fn facets(slopes: &Slopes) -> [f64; 3] {
    let ([along, across], turn) = lengthwise(slopes);
    if along <= across {
        return [across.sqrt(), 0.0, 0.0];
    }
    [across.sqrt(), ((along - across) / (1.0 - across)).sqrt(), turn]
}

/// The reflectance of the dielectric: an index where it is grey, a colour beside 1.5 otherwise.
fn reflectance(numbers: &mut Numbers, lines: &mut Vec<Line>, f0: Rgb) {
    let (color, most) = hue(f0);
    let index = index_of_f0(most.min(0.99));
    if color == [1.0; 3] && index <= IOR_MAX {
        numbers.ior = index;
        say(lines, "base: F0", ClosedForm, "an index of (1 + sqrt F0)/(1 - sqrt F0)");
    } else {
        numbers.specular_color = f0.map(|f| f / f0_of(IOR));
        say(lines, "base: F0", ClosedForm, "specularColor, over the F0 of index 1.5");
    }
}

fn diffuse(lines: &mut Vec<Line>, sigma: f64) {
    if sigma > 0.0 {
        say(lines, "base: sigma", Dropped, "diffuse bases are Lambert's");
    }
}

fn coated(
    coat: &surface::Coat,
    numbers: &mut Numbers,
    free: &mut Vec<Free>,
    lines: &mut Vec<Line>,
    frees_rough: &mut bool,
) -> Coat {
    let alpha = coat.slopes.facets.mean();
    if say_slopes(lines, "coat", &coat.slopes, "roughness is the root of alpha") {
        free.push(Free::CoatRoughness);
    }
    if coat.slopes.facets.alpha[0] != coat.slopes.facets.alpha[1] {
        say(lines, "coat: anisotropy", Dropped, "coats have no direction: the geometric mean of both slopes");
    }
    let mut weight = coat.weight;
    if (coat.ior - IOR).abs() > 1e-9 {
        weight = (weight * f0_of(coat.ior) / f0_of(IOR)).min(1.0);
        free.push(Free::CoatWeight);
        say(lines, "coat: index", Approximated, "coats have index 1.5: a weight fitted for it");
    } else {
        say(lines, "coat: index, weight", Kept, "");
    }
    if coat.depth != [0.0; 3] {
        say(lines, "coat: absorption", Approximated, "it is in the colour of the base, at all angles alike");
    }
    if coat.darkens {
        // The base below is as formulas of engines have it: what the layers do to it is in its numbers.
        let note = "light that goes to and fro below the coat, refraction and what the coat absorbs are in colour and roughness of the base, fitted";
        say(lines, "base below the coat", Approximated, note);
        if !free.contains(&Free::Color) {
            free.push(Free::Color);
        }
        if numbers.specular > 0.0 && most(numbers.specular_color) > 0.0 {
            let base = numbers.roughness * numbers.roughness;
            numbers.roughness = widened(base, coat).sqrt();
            *frees_rough = true;
        }
    } else {
        say(lines, "coat: darkening", Kept, "the base is as bright as its colour");
    }
    Coat { weight, color: [1.0; 3], roughness: alpha.sqrt(), anisotropy: 0.0, turn: 0.0, ior: IOR, darkens: false }
}
