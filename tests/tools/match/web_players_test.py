"""Players over UDP and over WebSockets in one match, with tokens; options that do not go together; TLS.

usage: web_players_test.py LOCKSTONE
"""

import json
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile

TICKS = 300
lockstone = sys.argv[1]


def run(*arguments):
    return subprocess.run([lockstone, *map(str, arguments)], capture_output=True, text=True, timeout=60, check=False)


def start(*arguments):
    return subprocess.Popen([lockstone, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def listening(server):
    udp = re.search(r"listening on 127\.0\.0\.1:(\d+)", server.stdout.readline())[1]
    return udp, re.search(r"listening on (wss?://127\.0\.0\.1:(\d+)/)", server.stdout.readline()).groups()


def plays_one_match(folder):
    key = folder / "key"
    run("token", "key", key)
    tokens = []
    for slot in range(4):
        tokens.append(folder / f"{slot}.token")
        run("token", "issue", "--key", key, "--match", 1, "--player", 100 + slot, "--slot", slot, "--out", tokens[-1])
    server = start("serve", "--key", key, "--match", 1, "--ws", 0, "--players", 4, "--ticks", TICKS, "--bodies", 20)
    udp, (url, _) = listening(server)
    clients = [start("join", "--token", tokens[slot], "--json", "--quiet",
                     *(["--ws", url] if slot % 2 else ["--server", f"127.0.0.1:{udp}"]), *(["--predict", 6] if slot > 1 else []))
               for slot in range(4)]
    text = server.communicate(timeout=60)[0]
    final = re.search(r"final hash ([0-9a-f]{16})", text)[1]
    for client in clients:
        result = json.loads(client.communicate(timeout=60)[0])
        assert (result["ticks"], result["final_hash"]) == (TICKS, final), result
    assert text.count(f"{TICKS} of {TICKS} hashes equal") == 4, text


def refuses_half_a_certificate():
    for options in (["--ws", 0, "--ws-cert", "x"], ["--ws-origin", "https://x"], ["--ws-cert", "x", "--ws-key", "y"]):
        refused = run("serve", "--insecure", *options)
        assert refused.returncode == 64 and "--ws" in refused.stderr, refused
    refused = run("serve", "--insecure", "--ws", 0, "--ws-cert", "/dev/null", "--ws-key", "/dev/null")
    assert refused.returncode == 69 and "certificate" in refused.stderr, refused


def encrypts_with_a_certificate(folder):
    if not shutil.which("openssl"):
        return
    certificate, key = folder / "cert.pem", folder / "key.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate, "-days", "2",
                    "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"], check=True, capture_output=True)
    server = start("serve", "--insecure", "--ws", 0, "--ws-cert", certificate, "--ws-key", key)
    _, (url, port) = listening(server)
    assert url.startswith("wss:"), url
    context = ssl.create_default_context(cafile=certificate)
    with context.wrap_socket(socket.create_connection(("127.0.0.1", port), 10), server_hostname="localhost") as line:
        line.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
                     b"Sec-WebSocket-Protocol: lockstone\r\n\r\n")
        answer = line.recv(1000)
    server.terminate()
    server.communicate(timeout=60)
    # The answer to that key: RFC 6455, section 1.3.
    assert b" 101 " in answer and b"s3pPLMBiTxaQ9kYGzzhZRbK+xOo=" in answer, answer


with tempfile.TemporaryDirectory() as temporary:
    plays_one_match(pathlib.Path(temporary))
    refuses_half_a_certificate()
    encrypts_with_a_certificate(pathlib.Path(temporary))
