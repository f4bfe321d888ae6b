//! Pictures of a material, inside the page.

use std::fmt::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD as STANDARD;

use crate::judge::evidence::Exhibit;
use crate::judge::report::MaterialReport;
use crate::text::format::{error, escape};

pub(super) fn write(out: &mut String, material: &MaterialReport, exhibits: &[Exhibit]) {
    if exhibits.is_empty() {
        return;
    }
    out.push_str("<div class=\"pictures\">");
    for exhibit in exhibits {
        let caption = escape(&exhibit.caption);
        let _ = write!(
            out,
            "<figure><img alt=\"{}: {caption}\" src=\"data:image/png;base64,{}\"/><figcaption>{caption}</figcaption></figure>",
            escape(&material.name),
            STANDARD.encode(&exhibit.png)
        );
    }
    out.push_str("</div>");
    if let Some(p) = &material.picture {
        let _ = write!(
            out,
            "<p class=\"note\">Baked against full: FLIP {} mean, {} largest; CIEDE2000 {} mean, {} largest; linear radiance {} RMS, {} \
             largest. The full form computes at three wavelengths and takes films at their nominal thickness. The differences therefore include the colour \
             error of three wavelengths, and the thickness maps of films.</p>",
            error(p.flip_mean),
            error(p.flip_max),
            error(p.delta_e_mean),
            error(p.delta_e_max),
            error(p.rms_err),
            error(p.max_abs_err)
        );
    }
}
