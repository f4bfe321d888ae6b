//! Values of inputs: constants, pictures, and what node graphs make of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::document::{Element, joined};
use super::expression::{Affine, Expression, Image, Op, UNPLACED, affine};
use super::nodes::node;
use super::value::{Space, Value, count, parse};

/// Most nodes on a way from an input to its values.
const DEPTH_MAX: usize = 200;

/// Most nodes that are evaluated for an input of a shader, and longest way through them.
const NODES_MAX: usize = 20_000;
const HEIGHT_MAX: usize = 1000;

/// Degrees of a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Where the names of nodes count: a document or a node graph, and what calls the graph.
#[derive(Debug, Clone)]
pub(super) struct Scope {
    element: Arc<Element>,
    /// The node whose inputs the graph has, and its own scope.
    caller: Option<(Arc<Element>, Arc<Scope>)>,
    /// The definition whose values hold where the caller has none.
    definition: Option<Arc<Element>>,
}

type Found = Result<Arc<Expression>, String>;

/// A document as values of inputs.
pub(super) struct Graph {
    root: Arc<Scope>,
    depth: usize,
    /// Nodes that were evaluated for the input at hand.
    evaluated: usize,
    /// Values of nodes that are known, by node, scope and output.
    known: BTreeMap<(usize, usize, String), Arc<Expression>>,
    /// Scopes of graphs by address, which live as long as their addresses are keys.
    scopes: BTreeMap<[usize; 3], Arc<Scope>>,
    /// Losses on the way to a value, which it survives.
    pub(super) notes: Vec<String>,
}

impl Graph {
    pub(super) fn new(root: &Arc<Element>) -> Self {
        let root = Arc::new(Scope { element: Arc::clone(root), caller: None, definition: None });
        Self { root, depth: 0, evaluated: 0, known: BTreeMap::new(), scopes: BTreeMap::new(), notes: Vec::new() }
    }

    pub(super) fn root(&self) -> &Arc<Scope> {
        &self.root
    }

    /// The scope of a graph.
    fn scope(
        &mut self,
        element: &Arc<Element>,
        caller: Option<(&Arc<Element>, &Arc<Scope>)>,
        definition: Option<&Arc<Element>>,
    ) -> Arc<Scope> {
        let [node, of] = caller.map_or([0; 2], |(node, of)| [Arc::as_ptr(node) as usize, Arc::as_ptr(of) as usize]);
        let key = [Arc::as_ptr(element) as usize, node, of];
        let make = || {
            Arc::new(Scope {
                element: Arc::clone(element),
                caller: caller.map(|(node, scope)| (Arc::clone(node), Arc::clone(scope))),
                definition: definition.cloned(),
            })
        };
        Arc::clone(self.scopes.entry(key).or_insert_with(make))
    }

    /// The node that an input is connected to, such as the shader of a material.
    pub(super) fn connected(&mut self, input: &Element, scope: &Arc<Scope>) -> Option<(Arc<Element>, Arc<Scope>)> {
        let (mut input, mut scope) = (Arc::new(input.clone()), Arc::clone(scope));
        for _ in 0..DEPTH_MAX {
            let Some(name) = input.attribute("nodegraph") else { break };
            let graph = Arc::clone(self.root.element.child(name)?);
            input = output_of(&graph, input.attribute("output"))?;
            scope = self.scope(&graph, None, None);
        }
        let name = input.attribute("nodename")?;
        let found = scope.element.child(name).or_else(|| self.root.element.child(name))?;
        Some((Arc::clone(found), scope))
    }

    /// The shader that a node stands for: one that is known, or what the document's own graph of the node has at its end.
    pub(super) fn shader(
        &mut self,
        shader: Arc<Element>,
        scope: Arc<Scope>,
        is_known: impl Fn(&str) -> bool,
    ) -> (Arc<Element>, Arc<Scope>) {
        let (mut at, mut of) = (Arc::clone(&shader), Arc::clone(&scope));
        for _ in 0..DEPTH_MAX {
            if is_known(&at.category) {
                return (at, of);
            }
            let inside = self.definition(&at).and_then(|(definition, graph)| {
                let output = output_of(&graph, None)?;
                let inside = self.scope(&graph, Some((&at, &of)), Some(&definition));
                self.connected(&output, &inside)
            });
            let Some(inside) = inside else { break };
            (at, of) = inside;
        }
        (shader, scope)
    }

    /// The value of an input of a shader.
    pub(super) fn value(&mut self, input: &Element, scope: &Arc<Scope>) -> Found {
        self.known.clear();
        self.evaluated = 0;
        self.input(input, scope)
    }

    /// The value of an input.
    pub(super) fn input(&mut self, input: &Element, scope: &Arc<Scope>) -> Found {
        self.depth += 1;
        let found = if self.depth > DEPTH_MAX {
            Err(format!("{}: more than {DEPTH_MAX} nodes lead to the value, or a circle of them", input.place))
        } else {
            self.of_input(input, scope)
        };
        self.depth -= 1;
        let mut found = found?;
        if input.attribute("unit") == Some("radian") {
            found = Expression::of(&[&found], |v| v[0].map(|angle| angle * DEGREES));
        }
        match input.attribute("channels") {
            Some(channels) => swizzled(&found, channels),
            None => Ok(found),
        }
    }

    fn of_input(&mut self, input: &Element, scope: &Arc<Scope>) -> Found {
        if let Some(name) = input.attribute("interfacename") {
            return self.interface(name, scope);
        }
        if let Some(name) = input.attribute("nodegraph") {
            let graph = self.root.element.child(name).cloned();
            let graph = graph.ok_or_else(|| format!("{}: there is no node graph `{name}`", input.place))?;
            return self.output(&graph, input.attribute("output"), None, None);
        }
        if let Some(name) = input.attribute("nodename") {
            let found = scope.element.child(name).or_else(|| self.root.element.child(name)).cloned();
            let node = found.ok_or_else(|| format!("{}: there is no node `{name}`", input.place))?;
            let value = self.node(&node, scope, input.attribute("output"))?;
            return Ok(fitted(&value, input.attribute("type")));
        }
        if let Some(name) = input.attribute("output") {
            let output = scope.element.child(name).filter(|found| found.category == "output").cloned();
            let output = output.ok_or_else(|| format!("{}: there is no output `{name}`", input.place))?;
            return self.input(&output, scope);
        }
        let is_given = input.attribute("value").is_some_and(|value| !value.is_empty());
        if !is_given && input.attribute("defaultgeomprop").is_some_and(is_texcoord) {
            return Ok(Arc::new(Expression::Texcoord));
        }
        constant(input)
    }

    /// The value that a graph has from outside.
    fn interface(&mut self, name: &str, scope: &Arc<Scope>) -> Found {
        if let Some((node, of)) = &scope.caller
            && let Some(given) = node.input(name)
        {
            return self.input(given, of);
        }
        let own = scope.element.input(name).or_else(|| scope.definition.as_ref().and_then(|found| found.input(name)));
        let own = own.cloned().ok_or_else(|| format!("{}: there is no input `{name}`", scope.element.place))?;
        let root = Arc::clone(&self.root);
        self.input(&own, &root)
    }

    /// The value of an output of a graph.
    fn output(
        &mut self,
        graph: &Arc<Element>,
        name: Option<&str>,
        caller: Option<(&Arc<Element>, &Arc<Scope>)>,
        definition: Option<&Arc<Element>>,
    ) -> Found {
        let output = output_of(graph, name)
            .ok_or_else(|| format!("{}: there is no output `{}`", graph.place, name.unwrap_or_default()))?;
        let scope = self.scope(graph, caller, definition);
        self.input(&output, &scope)
    }

    fn node(&mut self, node: &Arc<Element>, scope: &Arc<Scope>, output: Option<&str>) -> Found {
        let key = (Arc::as_ptr(node) as usize, Arc::as_ptr(scope) as usize, output.unwrap_or_default().to_owned());
        if let Some(known) = self.known.get(&key) {
            return Ok(Arc::clone(known));
        }
        self.evaluated += 1;
        if self.evaluated > NODES_MAX {
            return Err(format!("{}: more than {NODES_MAX} nodes lead to the value", node.place));
        }
        let found = self.evaluate(node, scope, output)?;
        if found.height() > HEIGHT_MAX {
            return Err(format!("{}: more than {HEIGHT_MAX} nodes lead to the value", node.place));
        }
        self.known.insert(key, Arc::clone(&found));
        Ok(found)
    }

    fn evaluate(&mut self, element: &Arc<Element>, scope: &Arc<Scope>, output: Option<&str>) -> Found {
        let of_type = element.attribute("type");
        match element.category.as_str() {
            "input" => return self.input(element, scope),
            "image" | "tiledimage" | "hextiledimage" | "gltf_image" | "gltf_colorimage" | "gltf_normalmap"
            | "UsdUVTexture" => {
                return self.image(element, scope, output);
            }
            "texcoord" => {
                let index = self.text(element, scope, "index").map(|(index, _)| index);
                if index.is_some_and(|index| index.trim() != "0") {
                    self.notes
                        .push("its texture coordinates are another set: shaders take one set for all maps".to_owned());
                }
                return Ok(Arc::new(Expression::Texcoord));
            }
            "geompropvalue" | "UsdPrimvarReader" => {
                let name = if element.category == "geompropvalue" { "geomprop" } else { "varname" };
                let name = self.text(element, scope, name).map(|(name, _)| name).unwrap_or_default();
                if of_type == Some("vector2") && is_texcoord(&name) {
                    return Ok(Arc::new(Expression::Texcoord));
                }
                return Err(format!("{}: `{name}` of the mesh is not read", element.place));
            }
            "multiply" => {
                let a = self.given(element, scope, "in1", 0.0)?;
                let b = self.given(element, scope, "in2", 1.0)?;
                return Ok(fitted(&a.times(&b), of_type));
            }
            "extract" => {
                let channel = self.given(element, scope, "index", 0.0)?.constant().map_or(0.0, Value::first);
                let value = self.given(element, scope, "in", 0.0)?;
                return Ok(channel_of(&value, channel.clamp(0.0, 3.0) as usize));
            }
            "separate2" | "separate3" | "separate4" => {
                let value = self.given(element, scope, "in", 0.0)?;
                return Ok(channel_of(
                    &value,
                    channel(output.unwrap_or("outx").trim_start_matches("out")).unwrap_or(0),
                ));
            }
            "swizzle" => {
                let value = self.given(element, scope, "in", 0.0)?;
                let channels = element.input("channels").and_then(|found| found.attribute("value")).unwrap_or("x");
                return Ok(fitted(&swizzled(&value, channels)?, of_type));
            }
            "normalmap" => {
                if self.text(element, scope, "space").is_some_and(|(space, _)| space == "object") {
                    return Err(format!("{}: normals in the frame of the object are not read", element.place));
                }
                let value = self.given(element, scope, "in", 0.5)?;
                let scale = self.given(element, scope, "scale", 1.0)?;
                if scale.constant().is_none_or(|scale| scale.count == 1) {
                    return Ok(normals(&value, &scale));
                }
                let slopes = Expression::of(&[&value, &scale], |v| {
                    let ([x, y, z], [s, t, ..]) = (v[0].three(), v[1].fitted(2).channels);
                    Value::rgb([0.5 + (x - 0.5) * s, 0.5 + (y - 0.5) * t, z])
                });
                return Ok(normals(&slopes, &Expression::number(1.0)));
            }
            _ => {}
        }
        if let Some((inputs, of)) = node(&element.category) {
            // Before 1.39 the inputs of `atan2` had other names.
            let is_old = element.category == "atan2" && element.input("in1").is_some();
            let given = inputs.iter().enumerate().map(|(number, (name, absent))| {
                let name = if is_old { ["in1", "in2"][number] } else { name };
                self.given(element, scope, name, *absent)
            });
            let given = given.collect::<Result<Vec<_>, _>>()?;
            return Ok(fitted(&Expression::apply(Op::Other(Arc::new(of)), given), of_type));
        }
        self.defined(element, scope, output)
    }

    /// The value of a node that the document itself defines by a graph.
    fn defined(&mut self, element: &Arc<Element>, scope: &Arc<Scope>, output: Option<&str>) -> Found {
        match self.definition(element) {
            Some((definition, graph)) => self.output(&graph, output, Some((element, scope)), Some(&definition)),
            None => Err(format!("{}: the node `{}` is not read", element.place, element.category)),
        }
    }

    /// The definition of a node that the document has, and its graph.
    fn definition(&self, element: &Element) -> Option<(Arc<Element>, Arc<Element>)> {
        let all = &self.root.element.children;
        let is_given = |definition: &&Arc<Element>| {
            let outputs: Vec<_> = definition.children.iter().filter(|child| child.category == "output").collect();
            let has_type = match outputs.as_slice() {
                [only] => only.attribute("type") == element.attribute("type") || element.attribute("type").is_none(),
                _ => true,
            };
            definition.category == "nodedef"
                && definition.attribute("node") == Some(&element.category)
                && element.attribute("nodedef").map_or(has_type, |name| definition.name() == name)
        };
        let graph = |name: &str| {
            let own = |found: &&Arc<Element>| found.category == "nodegraph" && found.attribute("nodedef") == Some(name);
            let link =
                |found: &&Arc<Element>| found.category == "implementation" && found.attribute("nodedef") == Some(name);
            let linked =
                || all.iter().filter(link).find_map(|found| self.root.element.child(found.attribute("nodegraph")?));
            all.iter().find(own).or_else(linked)
        };
        let found = all.iter().filter(is_given).find_map(|definition| Some((definition, graph(definition.name())?)))?;
        Some((Arc::clone(found.0), Arc::clone(found.1)))
    }

    /// An input of a node. Texture coordinates are those of the surface where none are given.
    fn given(&mut self, element: &Element, scope: &Arc<Scope>, name: &str, absent: f64) -> Found {
        match element.input(name) {
            Some(input) => self.input(input, scope),
            None if name == "texcoord" => Ok(Arc::new(Expression::Texcoord)),
            None => Ok(Expression::number(absent)),
        }
    }

    /// A constant input of a node.
    fn fixed(&mut self, element: &Element, scope: &Arc<Scope>, name: &str, absent: f64) -> Result<Value, String> {
        let value = self.given(element, scope, name, absent)?;
        value.constant().ok_or_else(|| format!("{}: `{name}` of `{}` varies", element.place, element.category))
    }

    /// A text of a node, which may come from outside its graph.
    fn text(&self, element: &Element, scope: &Arc<Scope>, name: &str) -> Option<(String, Arc<Element>)> {
        let mut input = Arc::clone(element.input(name)?);
        let mut scope = Arc::clone(scope);
        for _ in 0..DEPTH_MAX {
            let Some(outside) = input.attribute("interfacename") else {
                return input.attribute("value").map(|value| (value.to_owned(), Arc::clone(&input)));
            };
            let called = scope.caller.as_ref().and_then(|(node, of)| Some((node.input(outside)?.clone(), of.clone())));
            let own = || scope.element.input(outside).or_else(|| scope.definition.as_ref()?.input(outside));
            (input, scope) = called.or_else(|| Some((own()?.clone(), self.root.clone())))?;
        }
        None
    }

    fn image(&mut self, element: &Arc<Element>, scope: &Arc<Scope>, output: Option<&str>) -> Found {
        let Some((name, file)) = self.text(element, scope, "file").filter(|(name, _)| !name.is_empty()) else {
            return Err(format!("{}: `{}` names no picture", element.place, element.category));
        };
        if name.contains(['<', '>']) {
            return Err(format!(
                "{}: the picture `{name}` is one of many tiles or frames, which are not read",
                element.place
            ));
        }
        let is_usd = element.category == "UsdUVTexture";
        let is_gltf_color = element.category == "gltf_colorimage";
        let of_type = element.attribute("type").unwrap_or_default();
        let count = if is_usd || is_gltf_color { 4 } else { count(of_type).unwrap_or(3) };
        let is_color = is_usd || is_gltf_color || of_type.starts_with("color");
        let space = file.attribute("colorspace").unwrap_or(&file.color_space);
        let space = match self.text(element, scope, "sourceColorSpace") {
            Some((name, _)) if is_usd && name == "sRGB" => "srgb_texture".to_owned(),
            Some((name, _)) if is_usd && name == "raw" => "none".to_owned(),
            _ => space.to_owned(),
        };
        let space = if is_color { self.space(&space, &file) } else { Space::LINEAR };
        let mode = |name: &str| self.text(element, scope, name).map(|(mode, _)| mode);
        let modes = ["uaddressmode", "vaddressmode", "wrapS", "wrapT"].map(mode);
        let repeats = modes.iter().flatten().all(|mode| ["periodic", "repeat", "useMetadata"].contains(&mode.as_str()));
        let image = Image {
            path: joined(&file.folder, &format!("{}{name}", file.file_prefix)),
            count,
            space,
            placement: self.placement(element, scope)?,
            repeats,
        };
        let image = Arc::new(Expression::Image(Arc::new(image)));
        self.image_value(element, scope, output, image)
    }

    /// A picture times its factor, and the output that is asked for.
    fn image_value(
        &mut self,
        element: &Arc<Element>,
        scope: &Arc<Scope>,
        output: Option<&str>,
        image: Arc<Expression>,
    ) -> Found {
        Ok(match element.category.as_str() {
            "gltf_image" => image.times(&self.given(element, scope, "factor", 1.0)?),
            "gltf_normalmap" => normals(&image, &Expression::number(1.0)),
            "gltf_colorimage" => {
                let factor = self.given(element, scope, "color", 1.0)?;
                if element.input("geomcolor").is_some() {
                    self.notes.push("colours of the mesh are not read".to_owned());
                }
                if output == Some("outa") {
                    channel_of(&image, 3).times(&channel_of(&factor, 3))
                } else {
                    fitted(&image, Some("color3")).times(&fitted(&factor, Some("color3")))
                }
            }
            "UsdUVTexture" => {
                let [scale, bias] =
                    [("scale", 1.0), ("bias", 0.0)].map(|(name, absent)| self.fixed(element, scope, name, absent));
                let (scale, bias) = (scale?, bias?);
                let shifted = if bias.all().iter().all(|v| *v == 0.0) {
                    image.times(&Arc::new(Expression::Constant(scale)))
                } else {
                    Expression::of(&[&image], move |v| v[0].zip(scale, |a, b| a * b).zip(bias, |a, b| a + b))
                };
                match output {
                    Some("rgb") | None => fitted(&shifted, Some("color3")),
                    Some("rgba") => shifted,
                    Some(name) => channel_of(&shifted, channel(name).unwrap_or(0)),
                }
            }
            _ => image,
        })
    }

    /// From texture coordinates to those of a picture.
    fn placement(&mut self, element: &Arc<Element>, scope: &Arc<Scope>) -> Result<Affine, String> {
        let texcoord = if element.category == "UsdUVTexture" { "st" } else { "texcoord" };
        let given = match element.input(texcoord) {
            Some(input) => self.input(input, scope)?,
            None => Arc::new(Expression::Texcoord),
        };
        let uv = affine(&given)
            .ok_or_else(|| format!("{}: the texture coordinates of the picture are bent by a graph", element.place))?;
        let mut value = |name: &str, absent: f64| {
            self.fixed(element, scope, name, absent).map(|value| {
                let [u, v, ..] = value.fitted(2).channels;
                [u, v]
            })
        };
        let own: Arc<Expression> = match element.category.as_str() {
            "tiledimage" => {
                let [tiling, offset] = [value("uvtiling", 1.0)?, value("uvoffset", 0.0)?];
                let size = [value("realworldimagesize", 1.0)?, value("realworldtilesize", 1.0)?];
                Expression::of(&[&Arc::new(Expression::Texcoord)], move |v| {
                    let at = |c: usize| (v[0].channels[c] * tiling[c] - offset[c]) / size[0][c] * size[1][c];
                    Value::new(&[at(0), at(1)])
                })
            }
            "hextiledimage" => {
                self.notes.push("hexagonal tiles become plain repeats".to_owned());
                let tiling = self.fixed(element, scope, "tiling", 1.0)?.fitted(2);
                Expression::of(&[&Arc::new(Expression::Texcoord)], move |v| v[0].zip(tiling, |a, b| a * b))
            }
            "gltf_image" | "gltf_colorimage" | "gltf_normalmap" => {
                let ([x, y], [s, t], [ox, oy]) = (
                    match element.input("pivot") {
                        Some(_) => value("pivot", 0.0)?,
                        None => [0.0, 1.0],
                    },
                    value("scale", 1.0)?,
                    value("offset", 0.0)?,
                );
                let ([turn, _], [order, _]) = (value("rotate", 0.0)?, value("operationorder", 0.0)?);
                let order = if element.category == "gltf_colorimage" { 0.0 } else { order };
                let (_, place) = node("place2d").unwrap_or_else(|| unreachable!("the node is known"));
                Expression::of(&[&Arc::new(Expression::Texcoord)], move |v| {
                    let scale = Value::new(&[1.0 / s, 1.0 / t]);
                    let numbers = [
                        Value::new(&[x, y]),
                        scale,
                        Value::number(-turn),
                        Value::new(&[-ox, oy]),
                        Value::number(order),
                    ];
                    let all: Vec<Value> = v.iter().copied().chain(numbers).collect();
                    place(&all)
                })
            }
            _ => return Ok(uv),
        };
        let own = affine(&own).unwrap_or(UNPLACED);
        let after = |row: [f64; 3]| {
            let [a, b] = [0, 1].map(|c: usize| row[0] * uv[0][c] + row[1] * uv[1][c]);
            [a, b, row[0] * uv[0][2] + row[1] * uv[1][2] + row[2]]
        };
        Ok(own.map(after))
    }

    fn space(&mut self, name: &str, at: &Element) -> Space {
        Space::named(name).unwrap_or_else(|| {
            self.notes
                .push(format!("{}: the space of colours `{name}` is not known: read as linear Rec.709", at.place));
            Space::LINEAR
        })
    }
}

/// The constant of an input, a colour in linear Rec.709.
fn constant(input: &Element) -> Found {
    let of_type = input.attribute("type").unwrap_or("float");
    let text = input.attribute("value").ok_or_else(|| format!("{}: `{}` has no value", input.place, input.name()))?;
    let count = count(of_type).ok_or_else(|| format!("{}: the type `{of_type}` is not read", input.place))?;
    let value =
        parse(text, count).ok_or_else(|| format!("{}: `{text}` is no value of the type {of_type}", input.place))?;
    if !of_type.starts_with("color") {
        return Ok(Arc::new(Expression::Constant(value)));
    }
    let name = input.attribute("colorspace").unwrap_or(&input.color_space);
    let space =
        Space::named(name).ok_or_else(|| format!("{}: the space of colours `{name}` is not known", input.place))?;
    Ok(Arc::new(Expression::Constant(Value { channels: space.linear(value.channels), ..value })))
}

fn output_of(graph: &Element, name: Option<&str>) -> Option<Arc<Element>> {
    let mut outputs = graph.children.iter().filter(|child| child.category == "output");
    match name {
        Some(name) => outputs.find(|output| output.name() == name).cloned(),
        None => outputs.next().cloned(),
    }
}

/// A value in the numbers of a type.
fn fitted(value: &Arc<Expression>, of_type: Option<&str>) -> Arc<Expression> {
    let Some(count) = of_type.and_then(count) else { return Arc::clone(value) };
    match &**value {
        Expression::Constant(constant) => Arc::new(Expression::Constant(constant.fitted(count))),
        Expression::Image(image) if image.count == count => Arc::clone(value),
        Expression::Image(image) if image.count > 1 && count == 3 => {
            Arc::new(Expression::Image(Arc::new(Image { count, ..(**image).clone() })))
        }
        Expression::Image(_) if count == 1 => channel_of(value, 0),
        Expression::Apply(Op::Product, inputs, _) if has_constant(inputs) => {
            let inputs: Vec<_> = inputs.iter().map(|input| fitted(input, of_type)).collect();
            Expression::apply(Op::Product, inputs)
        }
        Expression::Apply(Op::Channel(_), ..) if count == 1 => Arc::clone(value),
        Expression::Apply(Op::Normals, ..) if count == 3 => Arc::clone(value),
        _ => Expression::of(&[value], move |v| v[0].fitted(count)),
    }
}

/// Whether a factor of a product is a constant, so that one way leads through it.
fn has_constant(inputs: &[Arc<Expression>]) -> bool {
    inputs.iter().any(|input| input.constant().is_some())
}

/// Whether a property of a mesh is its texture coordinates, by its name.
fn is_texcoord(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    ["uv", "st", "texcoord", "map1"].iter().any(|beginning| name.starts_with(beginning))
}

fn channel_of(value: &Arc<Expression>, channel: usize) -> Arc<Expression> {
    match &**value {
        // A picture of one number has it in red.
        Expression::Image(image) if image.count == 1 => Arc::clone(value),
        Expression::Apply(Op::Product, inputs, _) if has_constant(inputs) => {
            let inputs: Vec<_> = inputs.iter().map(|input| channel_of(input, channel)).collect();
            Expression::apply(Op::Product, inputs)
        }
        Expression::Apply(Op::Channel(_), ..) => Arc::clone(value),
        _ => Expression::apply(Op::Channel(channel), vec![Arc::clone(value)]),
    }
}

/// The number of a channel by its letter.
fn channel(letter: &str) -> Option<usize> {
    ["rx", "gy", "bz", "aw"].iter().position(|letters| !letter.is_empty() && letters.contains(letter))
}

fn swizzled(value: &Arc<Expression>, channels: &str) -> Found {
    let parts = channels.chars().map(|letter| match letter {
        '0' => Ok(Expression::number(0.0)),
        '1' => Ok(Expression::number(1.0)),
        _ => channel(&letter.to_string())
            .map(|channel| channel_of(value, channel))
            .ok_or_else(|| format!("`{channels}` are no channels")),
    });
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    match parts.as_slice() {
        [only] => Ok(Arc::clone(only)),
        _ if channels == "rgb" || channels == "xyz" => Ok(fitted(value, Some("color3"))),
        _ => Ok(Expression::apply(
            Op::Other(Arc::new(|v| Value::new(&v.iter().map(|v| v.first()).collect::<Vec<_>>()))),
            parts,
        )),
    }
}

/// Normals of a normal map, whose texels are (normal + 1) / 2.
fn normals(value: &Arc<Expression>, scale: &Arc<Expression>) -> Arc<Expression> {
    Expression::apply(Op::Normals, vec![Arc::clone(value), Arc::clone(scale)])
}
