//! Look-ups: WGSL that finds the texel position of a value in one layout.

use std::fmt::Write as _;

use luthier_lut::{Axis, Encoding, Mapping, RowBase, SchlickBase, TableKind};

use crate::compose::blocks::prune;
use crate::compose::feature::Feature;
use crate::compose::features::Features;
use crate::{Form, MaterialSet, ShaderError, TableFace};

macro_rules! module {
    ($($kind:ident $name:literal),+) => {
        /// The module of the look-up of a kind, with words in place of the layout of a table.
        pub(crate) fn module(kind: TableKind) -> &'static str {
            match kind {
                $(TableKind::$kind => include_str!(concat!("../wgsl/tables/", $name, ".wgsl")),)+
            }
        }
    };
}

luthier_lut::for_table_kinds!(module);

/// Types of the parameters of `luthier_lookup_NAME` in WGSL, the tile first, and of its value.
///
/// # Panics
/// Never for the look-ups that this crate has.
fn lookup_signature(kind: TableKind) -> (Vec<&'static str>, &'static str) {
    let opening = format!("fn luthier_lookup_{}(", kind.name());
    let declared =
        module(kind).lines().find_map(|line| line.strip_prefix(&opening)?.strip_suffix(" {")?.split_once(") -> "));
    let (parameters, value) = declared.unwrap_or_else(|| panic!("no look-up in the module of {}", kind.name()));
    (parameters.split(", ").filter_map(|parameter| Some(parameter.split_once(": ")?.1)).collect(), value)
}

/// Calls that use every binding of a set, so that naga reports the name it gives to each.
pub(crate) fn calls(set: &MaterialSet<'_>, form: Form) -> String {
    let mut out = "    _ = luthier_eval(0u, vec3<f32>(), vec3<f32>());\n".to_owned();
    for table in set.tables_read(form) {
        let arguments: Vec<String> = lookup_signature(table.kind).0.iter().map(|kind| format!("{kind}()")).collect();
        let _ = writeln!(out, "    _ = luthier_lookup_{}({});", table.kind.name(), arguments.join(", "));
    }
    if set.shows_environment(form) {
        out.push_str("    _ = luthier_environment(luthier_prepare(0u, vec3<f32>()), mat3x3<f32>(), 0.0);\n");
    }
    out
}

/// The look-up of a table in WGSL.
pub(crate) fn lookup(table: &TableFace, features: &Features) -> Result<String, ShaderError> {
    let kind = table.kind;
    let facts = kind.facts();
    let layout = &table.layout;
    if layout.columns == 0 || layout.tiles == 0 {
        return Err(ShaderError::layout(kind, "it has no tiles"));
    }
    if layout.y.is_some() != facts.y.is_some() {
        let expected = if facts.y.is_some() { "two axes are" } else { "one axis is" };
        return Err(ShaderError::layout(kind, format!("{expected} expected")));
    }
    check_axis(&layout.x, facts.x, kind)?;
    if let (Some(y), Some(quantity)) = (&layout.y, facts.y) {
        check_axis(y, &[quantity], kind)?;
    }
    if table.format.has_steps() && (layout.y.is_some() && layout.abreast().is_none() || layout.base != RowBase::Zero) {
        return Err(ShaderError::layout(kind, "texels with steps are those of rows"));
    }
    if layout.apron == 0 && layout.y.iter().chain([&layout.x]).any(|axis| axis.mapping == Mapping::Periodic) {
        return Err(ShaderError::layout(kind, "a periodic axis needs an apron"));
    }

    let has_base = layout.base == RowBase::Schlick;
    if has_base
        && (kind != TableKind::Fresnel || layout.x.quantity != "cos_theta" || table.format.unorm_max().is_none())
    {
        let reason = "only unorm rows of reflectance over cos_theta are added to Schlick's form";
        return Err(ShaderError::layout(kind, reason));
    }

    let has_angle = layout.x.quantity.starts_with("theta");
    let mut out = String::new();
    let is_split = Encoding::of(kind, table.format) == Encoding::SplitSixteenthRoot;
    let features = features.with(Feature::ThetaAxis, has_angle).with(Feature::SplitRoot, is_split);
    let features = features.with(Feature::SchlickBase, has_base);
    for line in prune(module(kind), &features).lines() {
        if let Some(value) = place(line, "let x = $x(") {
            let unit = if is_whole(table) { 1.0 / f64::from(layout.size()[0]) } else { 1.0 };
            node_index(&mut out, "x", &layout.x, value, unit);
        } else if let (Some(value), Some(y)) = (place(line, "let y = $y("), &layout.y) {
            node_index(&mut out, "y", y, value, 1.0);
        } else if line.contains("$position") {
            match table.format.has_steps() {
                true => texel(&mut out, table, &features),
                false => position(&mut out, table),
            }
        } else {
            let line = line.replace("$nodes", &layout.x.size.to_string());
            let line = line.replace("$span", &float(SchlickBase::span(table.format)));
            let _ = writeln!(out, "{}", line.replace("$read", &read(table)));
        }
    }
    Ok(out)
}

/// The argument of a word with brackets that stands alone on its line.
fn place<'l>(line: &'l str, opening: &str) -> Option<&'l str> {
    line.trim().strip_prefix(opening)?.strip_suffix(");")
}

fn check_axis(axis: &Axis, names: &[&str], table: TableKind) -> Result<(), ShaderError> {
    if !names.contains(&axis.quantity.as_str()) {
        let reason = format!("its axis is `{}`, known here: {}", axis.quantity, names.join(", "));
        return Err(ShaderError::layout(table, reason));
    }
    let is_range = axis.min.is_finite() && axis.max.is_finite() && axis.min < axis.max;
    let is_mapped = match axis.mapping {
        Mapping::Linear | Mapping::Periodic | Mapping::Apart => true,
        Mapping::Power { exponent } => exponent.is_finite() && exponent > 0.0,
        Mapping::Rational { bend } => bend.is_finite() && bend > 0.0,
        Mapping::Logarithmic => axis.min > 0.0,
    };
    if axis.size < 2 || !is_range || !is_mapped {
        let reason = format!("its axis `{}` has no valid range, size or mapping", axis.quantity);
        return Err(ShaderError::layout(table, reason));
    }
    Ok(())
}

/// Whether positions across a table are fractions of the atlas from the start, as samplers take them: one product and one sum.
///
/// Down the atlas, and across one with columns, positions are counted in texels and divided in the end. Such a quotient times its divisor is
/// mostly exact, so that unlike tiles do not bleed into each other by a rounding error. Tables that are not filtered, or whose rows are added to
/// Schlick's form, are read node by node: their positions stay in texels.
fn is_whole(table: &TableFace) -> bool {
    table.format.is_filterable() && table.layout.base == RowBase::Zero && table.layout.columns == 1
}

/// Writes `let position = ...;`: the place of node (x, y) of a tile in the atlas. [`is_whole`] decides the unit of x.
fn position(out: &mut String, table: &TableFace) {
    let layout = &table.layout;
    let half = f64::from(layout.apron) + 0.5;
    let [[width, height], [tile_width, tile_height]] = [layout.size(), layout.tile_size()];
    let unit = if is_whole(table) { 1.0 / f64::from(width) } else { 1.0 };
    // Rows lie side by side, or one below the other. The place of a row side by side is one sum of whole numbers and halves, which is exact, and one
    // quotient: far from the edge of the atlas, each further rounding would cost some millionths of a texel.
    let (across, y) = match (layout.abreast(), &layout.y) {
        (Some(_), _) => {
            let first = format!("y * {}.0 + {}", layout.row_size(), float(half));
            let first = if is_whole(table) { format!("({first}) / {width}.0") } else { first };
            (format!("{first} + x"), "0.5".to_owned())
        }
        (None, Some(_)) => (format!("x + {}", float(half * unit)), format!("y + {}", float(half))),
        (None, None) => (format!("x + {}", float(half * unit)), "0.5".to_owned()),
    };
    let down = match (layout.tiles, tile_height) {
        (1, _) => y.clone(),
        (_, 1) => "tile + 0.5".to_owned(),
        _ => format!("tile * {tile_height}.0 + {y}"),
    };
    let _ = match (is_whole(table), layout.columns) {
        (true, _) => {
            let down = if height == 1 { down } else { format!("({down}) / {height}.0") };
            writeln!(out, "    let position = vec2<f32>({across}, {down});")
        }
        (false, 1) => writeln!(out, "    let position = vec2<f32>({across}, {down});"),
        (false, columns) => writeln!(
            out,
            "    let row = floor((tile + 0.5) / {columns}.0);\n    \
             let column = tile - row * {columns}.0;\n    \
             let position = vec2<f32>(column * {tile_width}.0 + {across}, row * {tile_height}.0 + {y});"
        ),
    };
}

/// Writes the place of the interval about node (x, y) of a tile in a buffer, row by row, and the way from its first node to the second. Where
/// rows are over more than the view a tile may be fractional: the place in the next one, and the way there, follow.
fn texel(out: &mut String, table: &TableFace, features: &Features) {
    let is_between = features.has(Feature::LobesRows);
    let are_mixed = features.are_mixed_in(Feature::LobesRows);
    let layout = &table.layout;
    let ([width, _], [tile_width, _]) = (layout.size(), layout.tile_size());
    // At the last node the way to the next is 0.
    out.push_str("    let node = floor(x);\n");
    let (apron, row) = (layout.apron, layout.row_size());
    let across = match (layout.abreast(), apron) {
        // Two numbers, so that compilers know the first, and have the second once for all parts.
        (Some(_), _) => format!("u32(y * {row}.0 + {apron}.5) + u32(node)"),
        (None, 0) => "u32(node)".to_owned(),
        (None, _) => format!("u32(node) + {apron}u"),
    };
    let _ = match (is_between, layout.columns) {
        (true, _) => writeln!(
            out,
            "    let first_tile = floor(tile);\n    let across = {across};\n    \
             let texel = u32(first_tile) * {width}u + across;"
        ),
        (false, 1) if layout.tiles == 1 => writeln!(out, "    let texel = {across};"),
        (false, 1) => writeln!(out, "    let texel = u32(tile) * {width}u + {across};"),
        (false, columns) => writeln!(
            out,
            "    let row = u32(tile) / {columns}u;\n    \
             let texel = row * {width}u + (u32(tile) - row * {columns}u) * {tile_width}u + {across};"
        ),
    };
    let name = table.kind.name();
    let read = |texel| format!("luthier_stepped(luthier_{name}[{texel}], x - node)");
    if !is_between {
        let _ = writeln!(out, "    let value = {};", read("texel"));
        return;
    }
    let next = format!("min(u32(first_tile) + 1u, {}u) * {width}u + across", layout.tiles - 1);
    let _ = match are_mixed {
        false => writeln!(
            out,
            "    let next = {next};\n    let value = mix({}, {}, tile - first_tile);",
            read("texel"),
            read("next")
        ),
        // Materials with one tile read it alone.
        true => writeln!(
            out,
            "    var value = {};\n    if tile > first_tile {{\n        let next = {next};\n        \
                 value = mix(value, {}, tile - first_tile);\n    }}",
            read("texel"),
            read("next")
        ),
    };
}

fn read(table: &TableFace) -> String {
    let name = table.kind.name();
    if table.format.has_steps() {
        return "value".to_owned();
    }
    let [width, height] = table.layout.size();
    match (table.format.is_filterable(), is_whole(table)) {
        (true, true) => format!("textureSampleLevel(luthier_{name}, luthier_sampler, position, 0.0)"),
        (true, false) => format!(
            "textureSampleLevel(luthier_{name}, luthier_sampler, position / vec2<f32>({width}.0, {height}.0), 0.0)"
        ),
        (false, _) => format!("luthier_bilinear(luthier_{name}, position)"),
    }
}

/// Writes `let NAME = ...;`: the fractional node index of a value, times `unit`. It is [`Axis::index`] in WGSL.
fn node_index(out: &mut String, name: &str, axis: &Axis, value: &str, unit: f64) {
    let steps = f64::from(axis.intervals()) * unit;
    let range = axis.max - axis.min;
    let shifted = if axis.min == 0.0 { value.to_owned() } else { format!("({value} - {})", float(axis.min)) };
    let t = if range == 1.0 { shifted } else { format!("{shifted} / {}", float(range)) };
    let t = t.strip_prefix('(').and_then(|t| t.strip_suffix(')')).map_or(t.clone(), str::to_owned);
    let index = match axis.mapping {
        Mapping::Linear | Mapping::Apart => format!("saturate({t})"),
        Mapping::Periodic => format!("fract({t})"),
        Mapping::Logarithmic => {
            let scale = libm::log2(axis.max / axis.min);
            format!("saturate(log2(max({value}, {min}) / {min}) / {})", float(scale), min = float(axis.min))
        }
        Mapping::Rational { bend } => {
            let _ = writeln!(out, "    let {name}_t = saturate({t});");
            let _ = writeln!(
                out,
                "    let {name} = {name}_t / ({name}_t + {}) * {};",
                float(bend),
                float((1.0 + bend) * steps)
            );
            return;
        }
        Mapping::Power { exponent } => {
            if let Some(roots) = halvings(exponent) {
                format!("{}saturate({t}){}", "sqrt(".repeat(roots), ")".repeat(roots))
            } else if let Some(squares) = halvings(1.0 / exponent) {
                let _ = writeln!(out, "    var {name}_power = saturate({t});");
                for _ in 0..squares {
                    let _ = writeln!(out, "    {name}_power *= {name}_power;");
                }
                format!("{name}_power")
            } else {
                format!("pow(saturate({t}), {})", float(1.0 / exponent))
            }
        }
    };
    let _ = writeln!(out, "    let {name} = {index} * {};", float(steps));
}

/// The n of an exponent 2^n, from 2 to 2^8. Such powers are roots or squares in a row, which cost less than `pow`.
fn halvings(exponent: f64) -> Option<usize> {
    (1..=8).find(|&n| exponent == f64::from(1u32 << n))
}

/// A number as a WGSL literal that reads back as the same f32.
fn float(value: f64) -> String {
    format!("{:?}", value as f32)
}
