"""HTTP requests to a server on this machine, for the tests beside it."""

import urllib.error
import urllib.request


def ask(port, path):
    """The status and the text of an HTTP request."""
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=10) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
