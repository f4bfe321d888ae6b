//! A shared store that works, lies, is slow, is not there, and says no.

use std::fmt::{Display, Formatter};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

use async_trait::async_trait;
use luthier_bake::{Baked, JobKind, Observer, Options, bake_with};
use luthier_material::Material;
use object_store::memory::InMemory;
use object_store::*;
use tempfile::TempDir;

use super::*;
use crate::{DEFAULT_LIMIT, DiskStore, Layers};

/// Time of a request where all is well: a day, which no request in memory takes on any machine.
const PATIENT: Duration = Duration::from_secs(86_400);

/// Faults of a server.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    Unreachable,
    Silent,
    ReadsOnly,
}

/// Objects in memory, behind a server that may have a fault.
#[derive(Debug)]
struct Server {
    objects: InMemory,
    fault: Fault,
    requests: AtomicUsize,
    at_once: AtomicUsize,
    most_at_once: AtomicUsize,
}

impl Server {
    fn new(fault: Fault) -> Arc<Self> {
        let (requests, at_once, most_at_once) = Default::default();
        Arc::new(Self { objects: InMemory::new(), fault, requests, at_once, most_at_once })
    }

    fn store(self: &Arc<Self>, request_limit: Duration) -> RemoteStore {
        RemoteStore::start("s3://b/p".to_owned(), Arc::clone(self) as _, Path::from("p"), request_limit).unwrap()
    }

    /// A request comes in.
    async fn request(&self, is_upload: bool) -> Result<()> {
        self.requests.fetch_add(1, SeqCst);
        match self.fault {
            Fault::Unreachable => return Err(Error::Generic { store: "S3", source: "connection refused".into() }),
            Fault::ReadsOnly if is_upload => {
                return Err(Error::PermissionDenied { path: "p".to_owned(), source: "403".into() });
            }
            Fault::Silent => std::future::pending().await,
            Fault::None | Fault::ReadsOnly => {}
        }
        self.most_at_once.fetch_max(self.at_once.fetch_add(1, SeqCst) + 1, SeqCst);
        tokio::time::sleep(Duration::from_millis(2)).await;
        self.at_once.fetch_sub(1, SeqCst);
        Ok(())
    }

    /// Names and bytes of all objects.
    fn all(&self) -> Vec<(Path, Vec<u8>)> {
        pollster::block_on(async {
            let names = self.objects.list_with_delimiter(Some(&Path::from("p"))).await.unwrap().common_prefixes;
            let mut all = Vec::new();
            for folder in names {
                for object in self.objects.list_with_delimiter(Some(&folder)).await.unwrap().objects {
                    let bytes = self.objects.get(&object.location).await.unwrap().bytes().await.unwrap();
                    all.push((object.location, bytes.to_vec()));
                }
            }
            all
        })
    }

    fn plant(&self, name: &Path, bytes: &[u8]) {
        pollster::block_on(self.objects.put(name, bytes.to_vec().into())).unwrap();
    }
}

impl Display for Server {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("a server")
    }
}

type Stream<T> = std::pin::Pin<Box<dyn futures_core::Stream<Item = Result<T>> + Send>>;

#[async_trait]
impl ObjectStore for Server {
    async fn put_opts(&self, name: &Path, payload: PutPayload, options: PutOptions) -> Result<PutResult> {
        self.request(true).await?;
        self.objects.put_opts(name, payload, options).await
    }

    async fn get_opts(&self, name: &Path, options: GetOptions) -> Result<GetResult> {
        self.request(false).await?;
        self.objects.get_opts(name, options).await
    }

    async fn put_multipart_opts(&self, _: &Path, _: PutMultipartOptions) -> Result<Box<dyn MultipartUpload>> {
        unreachable!("no entry is large")
    }

    fn delete_stream(&self, _: Stream<Path>) -> Stream<Path> {
        unreachable!("no entry is deleted")
    }

    fn list(&self, _: Option<&Path>) -> Stream<ObjectMeta> {
        unreachable!("nothing is listed")
    }

    async fn list_with_delimiter(&self, _: Option<&Path>) -> Result<ListResult> {
        unreachable!("nothing is listed")
    }

    async fn copy_opts(&self, _: &Path, _: &Path, _: CopyOptions) -> Result<()> {
        unreachable!("nothing is copied")
    }
}

fn address(number: u32) -> Key {
    Key::of(&number.to_le_bytes())
}

/// Oracle: the bytes that were sent.
#[test]
fn what_one_machine_sends_another_finds() {
    let server = Server::new(Fault::None);
    let one = server.store(PATIENT);
    for number in 0..300 {
        one.send("row", address(number), &number.to_le_bytes());
    }
    one.close();
    let (name, object) = server.all().remove(0);
    let hex: String = name.as_ref().strip_prefix("p/").unwrap().strip_suffix("-row").unwrap().replace('/', "");
    let number = (0..300).find(|&number| address(number).to_string() == hex).unwrap();
    assert_eq!(object, pack(address(number), &number.to_le_bytes()));
    assert_eq!((server.all().len(), server.requests.load(SeqCst)), (300, 300));

    let two = server.store(PATIENT);
    let asked: Vec<(&str, Key)> = (0..400).map(|number| ("row", address(number))).collect();
    let expected: Vec<_> = (0..400_u32).map(|number| (number < 300).then(|| number.to_le_bytes().to_vec())).collect();
    assert_eq!(two.fetch(&asked), expected);
    assert_eq!(two.fetch(&[("fit", address(0))]), [None]);
    assert_eq!(server.most_at_once.load(SeqCst), 64);
    assert!(one.problem().is_none() && two.problem().is_none());
}

/// Oracle: the entries that were sent.
#[test]
fn damaged_and_misplaced_entries_are_refused_and_made_anew() {
    let server = Server::new(Fault::None);
    let store = server.store(PATIENT);
    let name = |number| store.transfers.name("row", address(number));
    for number in 0..4 {
        store.send("row", address(number), &[number as u8; 100]);
    }
    store.close();
    let whole = pack(address(0), &[0; 100]);
    server.plant(&name(0), &whole[..whole.len() - 1]);
    server.plant(&name(1), &pack(address(2), &[2; 100]));
    server.plant(&name(2), &pack(address(1), &[1; 100]));
    let asked: Vec<(&str, Key)> = (0..4).map(|number| ("row", address(number))).collect();
    assert_eq!(store.fetch(&asked), [None, None, None, Some(vec![3; 100])]);
    let problem = store.problem().unwrap().to_string();
    assert!(problem.contains("damaged entries") && problem.contains("s3://b/p"), "{problem}");
    assert!((0..3).any(|number| problem.ends_with(name(number).as_ref())), "{problem}");
    // What is computed then takes their places.
    store.send("row", address(0), &[0; 100]);
    store.close();
    assert_eq!(store.fetch(&asked[..1]), [Some(vec![0; 100])]);
    assert_eq!(store.problem(), None);
}

/// Whatever the fault, there is one reason, requests that wait do so side by side, and none follows the first that failed.
#[test]
fn a_store_that_fails_is_out_of_use() {
    for (fault, reason) in [
        (Fault::Unreachable, "connection refused"),
        (Fault::Silent, "it takes too long to answer"),
        (Fault::ReadsOnly, "access is denied"),
    ] {
        let server = Server::new(fault);
        let store = server.store(if fault == Fault::Silent { Duration::from_millis(50) } else { PATIENT });
        let asked: Vec<(&str, Key)> = (0..1000).map(|number| ("row", address(number))).collect();
        if fault == Fault::ReadsOnly {
            store.send("row", address(0), &[1; 100]);
            store.close();
        }
        assert_eq!(store.fetch(&asked), vec![None; 1000], "{fault:?}");
        let before = server.requests.load(SeqCst);
        assert!((1..=64).contains(&before), "{fault:?}: {before}");
        assert_eq!(store.fetch(&asked), vec![None; 1000], "{fault:?}");
        (0..100).for_each(|number| store.send("row", address(number), &[1; 1 << 20]));
        store.close();
        assert_eq!(server.requests.load(SeqCst), before, "{fault:?}");
        let problem = store.problem().unwrap().to_string();
        assert_eq!(problem, format!("the shared store s3://b/p is not used any more: {reason}"));
        assert_eq!(store.problem(), None, "{fault:?}");
    }
}

/// Uploads that wait for a server that never answers end when the time is up, and so does the bake that waits for room.
#[test]
fn uploads_end_with_the_store() {
    let server = Server::new(Fault::Silent);
    let store = server.store(Duration::from_millis(50));
    (0..100).for_each(|number| store.send("row", address(number), &[1; 1 << 20]));
    store.close();
    assert!(server.requests.load(SeqCst) <= 32);
    assert!(store.problem().is_some());
}

/// Kinds of the jobs that a bake runs.
#[derive(Default)]
struct Ran(Mutex<Vec<JobKind>>);

impl Observer for Ran {
    fn planned(&self, _: usize) {}
    fn finished(&self, kind: JobKind) {
        self.0.lock().unwrap().push(kind);
    }
    fn batch(&self, _: JobKind, _: bool) {}
}

fn material() -> Material {
    let text = "schema = 1\nname = \"coat\"\n[bake]\nmodel = \"elek\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n\
        [[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    luthier_material::parse("coat.toml", text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap().material
}

/// A bake on a machine with an empty folder: its tables, the jobs that ran, its folder, and the warning.
fn bake(server: &Arc<Server>) -> (Baked, usize, (TempDir, DiskStore), Option<String>) {
    let folder = tempfile::tempdir().unwrap();
    let disk = DiskStore::open(folder.path(), DEFAULT_LIMIT).unwrap();
    let remote = server.store(if server.fault == Fault::Silent { Duration::from_millis(50) } else { PATIENT });
    let (ran, no_images) = (Ran::default(), |_: &str, _: &luthier_material::PictureRef| Err("no images".to_owned()));
    let baked = bake_with(&[material()], &Options::default(), &no_images, &ran, &Layers(&[&disk, &remote])).unwrap();
    remote.close();
    assert!(disk.problem().is_none());
    (baked, ran.0.into_inner().unwrap().len(), (folder, disk), remote.problem().map(|problem| problem.to_string()))
}

/// Oracle: a bake on a machine alone.
#[test]
fn another_machine_computes_nothing_that_is_kept() {
    let server = Server::new(Fault::None);
    let (baked, ran, (_folder, disk), problem) = bake(&server);
    let kept = disk.usage().unwrap().all().entries as usize;
    assert!(kept > 0 && ran >= kept && problem.is_none(), "{kept} of {ran}: {problem:?}");
    assert_eq!(server.all().len(), kept);

    let (again, ran, (_folder, disk), problem) = bake(&server);
    assert_eq!((ran, problem), (0, None));
    assert!(again == baked);
    assert_eq!(disk.usage().unwrap().all().entries as usize, kept);

    // Of two entries, each is in the place of the other; another is damaged.
    let all = server.all();
    server.plant(&all[0].0, &all[1].1);
    server.plant(&all[1].0, &all[0].1);
    server.plant(&all[2].0, &all[2].1[1..]);
    let (lied, ran, _, problem) = bake(&server);
    assert!(lied == baked && ran >= 3 && problem.is_some(), "{ran}: {problem:?}");
    // They have been made anew.
    assert_eq!((server.all() == all, bake(&server).1), (true, 0));

    for fault in [Fault::Unreachable, Fault::Silent, Fault::ReadsOnly] {
        let (alone, _, _, problem) = bake(&Server::new(fault));
        assert!(alone == baked && problem.is_some(), "{fault:?}");
    }
}
