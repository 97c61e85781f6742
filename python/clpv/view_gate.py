# SPDX-License-Identifier: MIT
"""Gate of the viewer (clpv.view): requests need the token in the page's address, so that no other
page and no other user of the machine reaches the viewer. viser itself takes any request.

The gate depends on viser's inner parts, hence on its version."""
import functools
import http
import logging
import secrets
import unittest.mock

VISER = "1.1.1"          # tested version
MAX_BYTES = 1 << 16      # limit of one message; a page sends less than 1 KiB


def serve(token, inner, handler, host, port, **options):
    """websockets' serve() for requests below /TOKEN/."""
    def process_request(connection, request):
        found, _, request.path = request.path.removeprefix("/").partition("/")
        if not secrets.compare_digest(found.encode(), token.encode()):
            return connection.respond(http.HTTPStatus.FORBIDDEN, "found another address; allowed: "
                                      "the one that clpv.view printed\n")
        return options["process_request"](connection, request)

    return inner(handler, host, port,
                 **{**options, "process_request": process_request, "max_size": MAX_BYTES})


def opened(host, port):
    """A ViserServer and the path of its page. Raises RuntimeError for another version of viser."""
    import rich
    import viser
    import websockets.asyncio.server
    if viser.__version__ != VISER:
        raise RuntimeError(f"found viser {viser.__version__}, allowed: {VISER} "
                           f"(python3 -m pip install viser=={VISER})")
    # Connections that are no browser's would log tracebacks.
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)
    token = secrets.token_urlsafe(16)
    gated = functools.partial(serve, token, websockets.asyncio.server.serve)
    # viser prints an address without the token.
    with unittest.mock.patch.object(websockets.asyncio.server, "serve", gated), \
            unittest.mock.patch.object(rich, "print", lambda *_: None):
        return viser.ViserServer(host=host, port=port, label="clpv", verbose=False), f"/{token}/"
