//! Finds liblockstone_c: in the folder LOCKSTONE_LIB_DIR, or by pkg-config.
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-env-changed=LOCKSTONE_LIB_DIR");
    println!("cargo:rustc-link-lib=dylib=lockstone_c");
    if let Ok(folder) = std::env::var("LOCKSTONE_LIB_DIR") {
        println!("cargo:rustc-link-search=native={folder}");
        return;
    }
    let found = Command::new("pkg-config").args(["--libs-only-L", "lockstone_c"]).output();
    if let Ok(found) = found {
        for word in String::from_utf8_lossy(&found.stdout).split_whitespace() {
            println!("cargo:rustc-link-search=native={}", word.trim_start_matches("-L"));
        }
    }
}
