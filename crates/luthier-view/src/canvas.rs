//! Textures of the pictures that are shown.

use std::sync::Arc;

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};

use crate::comparison::difference;
use crate::work::painter::Picture;

/// A picture, and its texture.
#[derive(Default)]
pub(crate) struct Shown {
    picture: Option<Picture>,
    pub(crate) texture: Option<TextureHandle>,
}

impl Shown {
    pub(crate) fn is_empty(&self) -> bool {
        self.texture.is_none()
    }

    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    fn set(&mut self, context: &Context, name: &str, size: [usize; 2], rgb8: &[u8]) {
        let image = ColorImage::from_rgb(size, rgb8);
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => self.texture = Some(context.load_texture(name, image, TextureOptions::LINEAR)),
        }
    }
}

/// Textures of the two pictures and of their difference.
#[derive(Default)]
pub(crate) struct Canvas {
    pub(crate) sides: [Shown; 2],
    difference: Shown,
    /// Factor and pictures of the difference at hand.
    of_difference: Option<(f32, [Picture; 2])>,
    /// True while the mouse holds the divider.
    pub(crate) holds_divider: bool,
}

impl Canvas {
    /// Takes a picture of a side.
    pub(crate) fn take(&mut self, context: &Context, side: usize, picture: Picture) {
        let shown = &mut self.sides[side];
        if shown.picture.as_ref().is_some_and(|last| Arc::ptr_eq(&last.rgb8, &picture.rgb8)) {
            return;
        }
        let size = [picture.image.width as usize, picture.image.height as usize];
        shown.set(context, "picture", size, &picture.rgb8);
        shown.picture = Some(picture);
    }

    /// The texture of the difference; `None` while the pictures have other sizes.
    pub(crate) fn difference(&mut self, context: &Context, gain: f32) -> Option<&TextureHandle> {
        let [Some(a), Some(b)] = [&self.sides[0].picture, &self.sides[1].picture] else { return None };
        if !self.of_difference.as_ref().is_some_and(|(of, [c, d]): &(f32, [Picture; 2])| {
            *of == gain && Arc::ptr_eq(&c.image, &a.image) && Arc::ptr_eq(&d.image, &b.image)
        }) {
            let rgb8 = difference(&a.image, &b.image, gain)?;
            self.difference.set(context, "difference", [a.image.width as usize, a.image.height as usize], &rgb8);
            self.of_difference = Some((gain, [a.clone(), b.clone()]));
        }
        self.difference.texture.as_ref()
    }
}
