use std::ptr;

use crate::error::{c_text, check, definition, sized, Result};
use crate::sys;

definition!(
    /// Settings of a UDP socket that others call.
    EnetDef, lks_enet_def, lks_enet_def_init
);

/// Carries the packets of one session.
pub struct Transport {
    handle: *mut sys::lks_transport,
    pub(crate) connection: sys::lks_connection,
}

impl Drop for Transport {
    fn drop(&mut self) {
        unsafe { sys::lks_transport_destroy(self.handle) }
    }
}

impl Transport {
    /// A server's UDP socket at a numeric address; with the backend's key the match is encrypted.
    pub fn listen(def: &EnetDef, address: &str, key: Option<&[u8; 32]>) -> Result<Self> {
        let address = c_text(address)?;
        let key = key.map_or(ptr::null(), |key| key.as_ptr().cast());
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_enet_listen(&def.0, address.as_ptr(), key, &mut handle) })?;
        Ok(Transport { handle, connection: 0 })
    }
    /// A client's, which calls a server at a numeric address.
    pub fn connect(address: &str, port: u16) -> Result<Self> {
        let address = c_text(address)?;
        let (mut handle, mut connection) = (ptr::null_mut(), 0);
        check(unsafe { sys::lks_enet_connect(address.as_ptr(), port.into(), &mut handle, &mut connection) })?;
        Ok(Transport { handle, connection })
    }
    /// A client's, encrypted, by the text of a token.
    pub fn join(token: &str) -> Result<Self> {
        let token = c_text(token)?;
        let (mut handle, mut connection) = (ptr::null_mut(), 0);
        check(unsafe { sys::lks_enet_join(token.as_ptr(), &mut handle, &mut connection) })?;
        Ok(Transport { handle, connection })
    }
    pub(crate) fn as_ptr(&self) -> *mut sys::lks_transport {
        self.handle
    }
    pub fn port(&self) -> Result<u16> {
        let mut port = 0;
        check(unsafe { sys::lks_enet_port(self.handle, &mut port) })?;
        Ok(port as u16)
    }
    /// Sleeps until a datagram has come, at most that long.
    pub fn wait(&self, limit_us: i64) -> Result<()> {
        check(unsafe { sys::lks_enet_wait(self.handle, limit_us) })
    }
}

/// A token for one seat of one match, for `Transport::join`.
pub fn issue_token(
    key: &[u8; 32],
    match_id: u64,
    player: u64,
    slot: u32,
    expires_unix_s: u64,
    address: &str,
    port: u16,
) -> Result<String> {
    let address = c_text(address)?;
    let mut text = [0; 1029];
    check(unsafe {
        sys::lks_issue_token(
            key.as_ptr().cast(),
            match_id,
            player,
            slot,
            expires_unix_s,
            address.as_ptr(),
            port.into(),
            text.as_mut_ptr(),
            text.len(),
        )
    })?;
    Ok(crate::error::text_in(&text))
}

/// Faults of a link, in both directions.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinkFaults {
    pub loss_ppm: u32,
    pub duplicate_ppm: u32,
    pub reorder_ppm: u32,
    pub delay_us: i64,
    pub jitter_us: i64,
}

/// A network within the process, in the sessions' own time.
pub struct Network(*mut sys::lks_network);

impl Drop for Network {
    fn drop(&mut self) {
        unsafe { sys::lks_network_destroy(self.0) }
    }
}

impl Network {
    pub fn new(seed: u64) -> Result<Self> {
        let mut network = ptr::null_mut();
        check(unsafe { sys::lks_network_create(seed, &mut network) })?;
        Ok(Network(network))
    }
    /// The server's end.
    pub fn add(&self) -> Result<Transport> {
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_network_add(self.0, &mut handle) })?;
        Ok(Transport { handle, connection: 0 })
    }
    /// A client's end, which calls the server's.
    pub fn connect(&self, server: &Transport, faults: &LinkFaults) -> Result<Transport> {
        let mut end = self.add()?;
        let mut raw = sized!(lks_link_faults);
        raw.loss_ppm = faults.loss_ppm;
        raw.duplicate_ppm = faults.duplicate_ppm;
        raw.reorder_ppm = faults.reorder_ppm;
        raw.delay_us = faults.delay_us;
        raw.jitter_us = faults.jitter_us;
        check(unsafe { sys::lks_network_connect(self.0, end.handle, server.handle, &raw, &mut end.connection) })?;
        Ok(end)
    }
}
