//! Where the files of the page are.

use crate::failure::Failure;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The folder `web` of the repository.
#[derive(Debug)]
pub(crate) struct Sources {
    web: PathBuf,
}

impl Sources {
    /// Finds the folder: cargo names it to the programs that it runs, and a program that was started otherwise knows where it
    /// was compiled.
    pub(crate) fn find() -> Result<Sources, Failure> {
        let named = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let named = named.filter(|folder| folder.join("page").is_dir());
        let web = named.unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        if !web.join("page").is_dir() {
            let error = io::ErrorKind::NotFound.into();
            return Err(Failure::Source { path: web.join("page"), error });
        }
        Ok(Sources { web })
    }

    /// The root of the workspace.
    pub(crate) fn root(&self) -> &Path {
        self.web.parent().unwrap_or(&self.web)
    }

    /// The path of a file of the page.
    pub(crate) fn page(&self, name: &str) -> PathBuf {
        self.web.join("page").join(name)
    }

    /// The text of a file of the page.
    pub(crate) fn read(&self, name: &str) -> Result<String, Failure> {
        let path = self.page(name);
        fs::read_to_string(&path).map_err(|error| Failure::Source { path, error })
    }

    /// The texts of the files that `FOLDER/order.txt` lists, a name a line, in this order; `#` begins a comment.
    pub(crate) fn in_order(&self, folder: &str) -> Result<Vec<(String, String)>, Failure> {
        let order = self.read(&format!("{folder}/order.txt"))?;
        let names = order.lines().filter_map(|line| line.split('#').next()).map(str::trim);
        let names = names.filter(|name| !name.is_empty()).map(|name| format!("{folder}/{name}"));
        names.map(|name| self.read(&name).map(|text| (name, text))).collect()
    }
}
