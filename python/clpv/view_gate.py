# SPDX-License-Identifier: MIT
"""Gate of the viewer (clpv.view): admits requests of its own page, and the messages that it sends.

viser itself accepts any Host and Origin, sets any attribute of a control, and opens a public tunnel
on a client's request. Values are checked where they are used. The gate depends on viser's inner
parts, hence on its version.
"""
import http
import ipaddress
import logging
import socket
import unittest.mock

VISER = "1.1.1"          # tested version
MAX_BYTES = 1 << 16      # limit of one message; a page sends less than 1 KiB


def is_loopback(host):
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


class Ignored:
    """A message without a handler."""


class Gate:
    """Checks requests (Host, Origin) and messages. `host`: address that the server listens on."""

    def __init__(self, host):
        # Other pages have names. An address as Host cannot be one of theirs.
        self.any_address = not is_loopback(host)
        self.names = {"localhost", "127.0.0.1", "::1", host.lower()}
        if self.any_address:
            self.names |= {socket.gethostname().lower(), socket.getfqdn().lower()}

    def refusal(self, headers):
        """Returns why a request is refused, or None: header, value found, values allowed."""
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        if len(hosts) != 1 or not self.is_own(hosts[0]):
            return f"Host: found {hosts}, allowed: this machine's"
        if origins not in ([], [f"http://{hosts[0]}"], [f"https://{hosts[0]}"]):
            return f"Origin: found {origins}, allowed: http://{hosts[0]}"
        return None

    def is_own(self, host):
        name = host.lower()
        if ":" in name and not name.endswith("]"):
            name = name[:name.rindex(":")]  # the port: a forwarded connection may have another
        name = name.strip("[]")
        if name in self.names:
            return True
        try:
            return self.any_address and bool(ipaddress.ip_address(name))
        except ValueError:
            return False

    def deserialize(self, raw):
        """Returns viser's message in these bytes, or Ignored if it is not allowed.

        Ends the connection if the bytes are no message.
        """
        from viser import _messages
        from websockets.exceptions import ConnectionClosedError
        try:
            message = _messages.Message.deserialize(raw)
            sets = [*message.updates] if isinstance(message, _messages.GuiUpdateMessage) else []
        except Exception as error:  # whatever the decoders raise
            raise ConnectionClosedError(None, None) from error
        allowed = sets == ["value"] or isinstance(message, (
            _messages.ViewerCameraMessage, _messages.ScenePointerMessage,
            _messages.CommandTriggerMessage))
        return message if allowed else Ignored()

    def serve(self, handler, host, port, **options):
        """websockets' serve() behind this gate."""
        inner = options["process_request"]

        def process_request(connection, request):
            why = self.refusal(request.headers)
            if why:
                return connection.respond(http.HTTPStatus.FORBIDDEN, f"{why}\n")
            return inner(connection, request)

        options.update(process_request=process_request, max_size=MAX_BYTES)
        return self.inner_serve(handler, host, port, **options)

    def open(self, host, port):
        """A ViserServer behind this gate. Raises RuntimeError for another version of viser."""
        import rich
        import viser
        import viser.infra
        import websockets.asyncio.server
        if viser.__version__ != VISER:
            raise RuntimeError(f"found viser {viser.__version__}, allowed: {VISER} "
                               f"(python3 -m pip install viser=={VISER})")
        # Connections that are no browser's would log tracebacks.
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)
        self.inner_serve, inner_server = websockets.asyncio.server.serve, viser.infra.WebsockServer

        def checked_server(**options):
            return inner_server(**{**options, "message_class": self})

        # viser prints the address of IPv6 without brackets.
        with unittest.mock.patch.object(websockets.asyncio.server, "serve", self.serve), \
                unittest.mock.patch.object(viser.infra, "WebsockServer", checked_server), \
                unittest.mock.patch.object(rich, "print", lambda *_: None):
            return viser.ViserServer(host=host, port=port, label="clpv", verbose=False)
