//! `--store`: refused where the build has no shared stores, and where it is the address of none.

use luthier_workshop::material_texts::gold;

use crate::workshop::Workshop;

#[test]
fn a_store_that_cannot_be_is_refused() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    let bake = |url| workshop.run(&["bake", "gold.toml", "--quiet", "--store", url]);
    if cfg!(feature = "remote") {
        bake("ftp://host/store").fails(2, &["ftp://host/store", "s3://BUCKET/PREFIX"]);
        bake("file:///store").fails(2, &["--cache"]);
    } else {
        bake("s3://bucket/store").fails(2, &["--store", "--features remote"]);
    }
    workshop.run(&["bake", "gold.toml", "--no-cache", "--store", "s3://bucket/store"]).fails(2, &["--store"]);
    assert!(!workshop.path("out").exists());
}
