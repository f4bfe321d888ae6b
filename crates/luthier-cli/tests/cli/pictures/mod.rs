//! Pictures, and the window.

#[cfg(feature = "gpu")]
mod compare;
#[cfg(all(feature = "gpu", target_os = "linux"))]
mod driver;
mod environment;
#[cfg(feature = "gpu")]
mod gallery;
mod gallery_page;
#[cfg(feature = "gpu")]
mod noise;
#[cfg(feature = "gpu")]
mod preview;
#[cfg(all(feature = "view", unix))]
mod view;
