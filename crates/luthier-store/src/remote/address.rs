//! The address of a shared store, and the environment variables for it.

use std::sync::Arc;
use std::time::Duration;

use object_store::aws::AmazonS3Builder;
use object_store::azure::MicrosoftAzureBuilder;
use object_store::gcp::GoogleCloudStorageBuilder;
use object_store::http::HttpBuilder;
use object_store::path::Path;
use object_store::{BackoffConfig, ClientConfigKey, ObjectStore, ObjectStoreScheme, RetryConfig};
use url::{Position, Url};

use super::RemoteError;
use super::error::reason;

/// Retries of a request that a server refused for a moment, or that did not reach the server.
const RETRIES: usize = 3;

/// Time after which no retry begins: a user who has waited this long should not wait again.
const RETRY_LIMIT: Duration = Duration::from_secs(10);

/// An address, taken apart.
pub(super) struct Address {
    /// The address for messages, without parts that may be secret.
    pub(super) name: String,
    /// The objects, or why they cannot be reached.
    pub(super) objects: Result<Arc<dyn ObjectStore>, String>,
    /// The beginning of the names of all objects.
    pub(super) prefix: Path,
}

impl Address {
    pub(super) fn parse(text: &str) -> Result<Self, RemoteError> {
        let refused =
            |store: &str, reason: &str| RemoteError::Address { store: store.to_owned(), reason: reason.to_owned() };
        let forms =
            "addresses are s3://BUCKET/PREFIX, gs://BUCKET/PREFIX, az://CONTAINER/PREFIX and https://HOST/PREFIX";
        // The text is not shown: it may still hold a password.
        let url = Url::parse(text).map_err(|_| refused("what is no address", forms))?;
        let name = public(&url);
        let (scheme, prefix) = ObjectStoreScheme::parse(&url).map_err(|_| refused(&name, forms))?;
        let objects = match scheme {
            ObjectStoreScheme::AmazonS3 => s3(&url),
            ObjectStoreScheme::GoogleCloudStorage => google(&url),
            ObjectStoreScheme::MicrosoftAzure => azure(&url),
            ObjectStoreScheme::Http => http(&url),
            ObjectStoreScheme::Local => {
                return Err(refused(&name, "a folder that machines share is named with --cache"));
            }
            _ => return Err(refused(&name, forms)),
        };
        Ok(Self { name, objects: objects.map_err(|error| reason(&error)), prefix })
    }
}

type Built = object_store::Result<Arc<dyn ObjectStore>>;

fn s3(url: &Url) -> Built {
    let builder = AmazonS3Builder::from_env().with_url(url.as_str()).with_retry(retry());
    Ok(Arc::new(builder.build()?))
}

fn google(url: &Url) -> Built {
    let builder = GoogleCloudStorageBuilder::from_env().with_url(url.as_str()).with_retry(retry());
    Ok(Arc::new(builder.build()?))
}

fn azure(url: &Url) -> Built {
    let builder = MicrosoftAzureBuilder::from_env().with_url(url.as_str()).with_retry(retry());
    Ok(Arc::new(builder.build()?))
}

/// A store over HTTP. `http://` turns encryption off.
fn http(url: &Url) -> Built {
    let builder = HttpBuilder::new()
        .with_url(&url[..Position::BeforePath])
        .with_config(ClientConfigKey::AllowHttp, (url.scheme() == "http").to_string())
        .with_retry(retry());
    Ok(Arc::new(builder.build()?))
}

/// Settings of retries: few. Unless variables say otherwise, a connection is given up after 5 s.
fn retry() -> RetryConfig {
    RetryConfig { backoff: BackoffConfig::default(), max_retries: RETRIES, retry_timeout: RETRY_LIMIT }
}

/// An address without names, passwords and signatures.
fn public(url: &Url) -> String {
    // Not even a host: such a text may hold anything.
    if url.cannot_be_a_base() {
        return format!("{}:…", url.scheme());
    }
    let mut public = url.clone();
    public.set_query(None);
    public.set_fragment(None);
    // An address without a host has neither.
    let _ = public.set_username("");
    let _ = public.set_password(None);
    public.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_taken_apart() {
        for (text, name, prefix) in [
            ("s3://bucket/a/b", "s3://bucket/a/b", "a/b"),
            ("s3://bucket", "s3://bucket", ""),
            ("https://user:secret@host/a?sig=secret#c", "https://host/a", "a"),
            ("http://host:80/", "http://host/", ""),
            ("gs://bucket/a", "gs://bucket/a", "a"),
            ("az://container/a", "az://container/a", "a"),
        ] {
            let address = Address::parse(text).unwrap();
            assert_eq!((address.name.as_str(), address.prefix.as_ref()), (name, prefix));
        }
        for (text, says) in [
            ("bucket", "addresses are s3://"),
            ("user:secret", "addresses are s3://"),
            ("ftp://host/a", "addresses are s3://"),
            ("memory:///a", "addresses are s3://"),
            ("file:///a", "--cache"),
        ] {
            let error = Address::parse(text).err().unwrap().to_string();
            assert!(error.contains(says) && !error.contains("secret"), "{text}: {error}");
        }
    }
}
