//! Numbers of OpenPBR 1.1.

use luthier_import::Fate::{Approximated, ClosedForm, Kept};
use luthier_import::Line;
use luthier_optics::Rgb;
use luthier_optics::schlick::index_of_f0;

use super::{Closed, FILM_ON_METAL, FITTED_BELOW_FILM, film, held, hue, lengthwise, say, say_slopes, transmittance};
use crate::fit::Free;
use crate::numbers::{Coat, Numbers};
use crate::surface::{Base, Slopes, Surface};

/// Roughness of the format's diffuse base over the slope deviation of Oren and Nayar's: the import has the inverse.
const ROUGHNESS_OF_SIGMA: f64 = 1.0 / 0.3;

const SLOPES: &str = "alpha_x = r^2 sqrt(2/(1 + (1 - a)^2)), alpha_y = (1 - a) alpha_x, turned round";

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
                let below = coat.map(|coat| [coat.ior, coat.weight]);
                reflectance(&mut numbers, &mut lines, stated.dielectric, below);
                diffuse(&mut numbers, &mut lines, *sigma);
            }
            if stated.metallic > 0.0 {
                numbers.specular_color = stated.f82_tint;
                say(&mut lines, "base: f82_tint", Kept, "");
            }
        }
        Base::Metal(curves) => {
            numbers.metallic = 1.0;
            numbers.base_color = held(&mut lines, curves.map(|curve| curve.f0));
            numbers.specular_color = curves.map(|curve| curve.tint.clamp(0.0, 1.0));
            say(&mut lines, "base: index", ClosedForm, "its reflectance along the normal and at 82 degrees");
            if surface.film.is_some() {
                free.push(Free::Color);
                say(&mut lines, FILM_ON_METAL, Approximated, FITTED_BELOW_FILM);
            }
        }
        Base::Plastic(plastic) => {
            numbers.base_color = plastic.diffuse.albedo;
            if coat.is_none() && (plastic.is_coat() || plastic.absorbs()) {
                coat = Some(plastic.as_coat(surface.slopes));
                (numbers.specular, is_matte) = (0.0, true);
                say(&mut lines, "base: albedo", Kept, "below a coat, in place of a dielectric of its own");
            } else {
                let below = coat.map(|coat| [coat.ior, coat.weight]);
                reflectance(&mut numbers, &mut lines, plastic.f0, below);
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
            let below = coat.map(|coat| [coat.ior, coat.weight]);
            reflectance(&mut numbers, &mut lines, *f0, below);
            say(&mut lines, "what lies below", Approximated, "light that goes through is lost: the base is black");
        }
    }
    if is_matte {
        numbers.roughness = 1.0;
    } else {
        if say_slopes(&mut lines, "base", &surface.slopes, SLOPES) {
            free.push(Free::Roughness);
        }
        [numbers.roughness, numbers.anisotropy, numbers.turn] = facets(&surface.slopes);
    }
    if let Some(coat) = &coat {
        if say_slopes(&mut lines, "coat", &coat.slopes, SLOPES) {
            free.push(Free::CoatRoughness);
        }
        let [roughness, anisotropy, turn] = facets(&coat.slopes);
        say(&mut lines, "coat: index, weight, darkening", Kept, "");
        if coat.depth != [0.0; 3] {
            say(
                &mut lines,
                "coat: absorption",
                ClosedForm,
                "coat_color is what goes through it and back along the normal",
            );
        }
        let color = transmittance(coat.depth);
        let (weight, ior, darkens) = (coat.weight, coat.ior, coat.darkens);
        numbers.coat = Some(Coat { weight, color, roughness, anisotropy, turn, ior, darkens });
    }
    numbers.film = film(&mut lines, surface.film.as_ref());
    Closed { numbers, free, lines }
}

/// Roughness, anisotropy and turn.
pub(super) fn facets(slopes: &Slopes) -> [f64; 3] {
    let ([along, across], turn) = lengthwise(slopes);
    if along <= across {
        return [along.sqrt(), 0.0, 0.0];
    }
    let rest = across / along;
    [(along / (2.0 / (1.0 + rest * rest)).sqrt()).sqrt(), 1.0 - rest, turn]
}

fn diffuse(numbers: &mut Numbers, lines: &mut Vec<Line>, sigma: f64) {
    if sigma > 0.0 {
        numbers.diffuse_roughness = (ROUGHNESS_OF_SIGMA * sigma).min(1.0);
        let note = "base_diffuse_roughness that loses as little light; the format's edge is flatter";
        say(lines, "base: sigma", Approximated, note);
    }
}

/// The reflectance of the dielectric, below a coat of an index and a weight: the format has an index in air, and turns the ratio to that of the coat over where it is below 1.
fn reflectance(numbers: &mut Numbers, lines: &mut Vec<Line>, f0: Rgb, coat: Option<[f64; 2]>) {
    let (color, most) = hue(f0);
    if most == 0.0 {
        numbers.specular = if numbers.ior == 1.0 { 1.0 } else { 0.0 };
        return;
    }
    numbers.specular_color = color;
    let wanted = index_of_f0(most.min(0.99));
    let [over, weight] = coat.unwrap_or([1.0, 0.0]);
    let seen = |ior: f64| ior + weight * ((ior / over).max(over / ior) - ior);
    if let Some(ior) = solved(seen, wanted) {
        numbers.ior = ior;
        say(lines, "base: F0", ClosedForm, "specular_ior, below a coat of the ratio to its index");
    } else {
        let root = |n: f64| (n - 1.0) / (n + 1.0);
        numbers.specular = most / (root(seen(numbers.ior)) * root(seen(numbers.ior)));
        say(lines, "base: F0", ClosedForm, "specular_weight, because no index below this coat reflects as little");
    }
}

/// Index of usual plastics: of two indices, the one above and the one below a coat, the nearer counts.
const USUAL: f64 = 1.55;

/// The solution of `seen(x) = wanted` nearest to [`USUAL`], by bisection between points of a grid from 1 to 10.
fn solved(seen: impl Fn(f64) -> f64, wanted: f64) -> Option<f64> {
    const POINTS: u32 = 900;
    let point = |i: u32| 1.0 + 9.0 * f64::from(i) / f64::from(POINTS);
    let mut found: Option<f64> = None;
    for i in 0..POINTS {
        let [mut low, mut high] = [point(i), point(i + 1)];
        let sign = |x: f64| (seen(x) - wanted) >= 0.0;
        if sign(low) == sign(high) && seen(low) != wanted {
            continue;
        }
        let is_up = sign(high);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if sign(middle) == is_up {
                high = middle;
            } else {
                low = middle;
            }
        }
        let far = |x: f64| libm::log(x / USUAL).abs();
        if found.is_none_or(|found| far(high) < far(found)) {
            found = Some(high);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Index 1.5 below a coat of 1.6 is a ratio of 1.0667, and 1.7067 would be one, too; half a coat of 1.5 over index 2: 2 + (1.3333 - 2)/2 = 1.6667.
    #[test]
    fn indices_below_coats_are_found_again() {
        let ratio: f64 = 1.6 / 1.5;
        let f0 = |n: f64| ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
        for (f0, coat, expected) in
            [(f0(ratio), [1.6, 1.0], 1.5), (f0(5.0 / 3.0), [1.5, 0.5], 2.0), (0.04, [1.0, 0.0], 1.5)]
        {
            let (mut numbers, mut lines) = (Numbers::plain(), Vec::new());
            reflectance(&mut numbers, &mut lines, [f0; 3], Some(coat));
            assert!((numbers.ior - expected).abs() < 1e-9, "{expected}: {numbers:?}");
        }
    }
}
