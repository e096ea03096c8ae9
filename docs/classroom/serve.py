#!/usr/bin/env python3
"""Shows a terminal program in a browser.

    serve.py PORT [--write] [--most COUNT] -- COMMAND [ARGUMENT...]

Listens on 127.0.0.1 only. Without --write nothing typed in the browser is
passed on. At most 40 pages, or COUNT, are open at once; others are told so. Needs terminado from PyPI, and xterm.js from npm in the folder where
it is started: npm install @xterm/xterm @xterm/addon-fit
"""
import json
import shutil
import sys

import terminado
import tornado.ioloop
import tornado.web

PAGE = """<!doctype html><meta charset="utf-8"><title>rubscope</title>
<link rel="stylesheet" href="js/xterm/css/xterm.css">
<style>html, body, #t { height: 100%; margin: 0; background: #000 }</style><div id="t"></div>
<script src="js/xterm/lib/xterm.js"></script><script src="js/addon-fit/lib/addon-fit.js"></script>
<script>
const term = new Terminal({ fontFamily: "DejaVu Sans Mono, monospace" });
const fit = new FitAddon.FitAddon();
term.loadAddon(fit);
term.open(document.getElementById("t"));
const socket = new WebSocket(location.href.replace("http", "ws") + "socket");
const send = (...message) => socket.send(JSON.stringify(message));
socket.onopen = () => { fit.fit(); send("set_size", term.rows, term.cols); term.focus(); };
socket.onmessage = (event) => {
  const [kind, text] = JSON.parse(event.data);
  if (kind === "stdout") term.write(text);
};
socket.onclose = (event) => term.write(`\\r\\n[${event.reason || "the session has ended"}]`);
term.onData((text) => send("stdin", text));
term.onResize(({ rows, cols }) => send("set_size", rows, cols));
window.onresize = () => fit.fit();
</script>"""


class Page(tornado.web.RequestHandler):
    def get(self):
        self.write(PAGE)


class Socket(terminado.TermSocket):
    """Tornado refuses the socket to pages from elsewhere."""

    def open(self, *arguments):
        try:
            super().open(*arguments)
        except terminado.management.MaxTerminalsReached:
            self.close(1013, f"{most} pages are open, and no more are allowed")

    def on_message(self, message):
        if self.terminal and (write or json.loads(message)[0] == "set_size"):
            super().on_message(message)


if "--" not in sys.argv[2:]:
    sys.exit(__doc__.strip())
split = sys.argv.index("--")
port, *options = sys.argv[1:split]
if not (port.isdecimal() and port.isascii() and 1 <= int(port) <= 65535):
    sys.exit(f"serve.py: PORT = {port}: allowed is a whole number from 1 to 65535")
command = sys.argv[split + 1 :]
if not command or not shutil.which(command[0]):
    sys.exit(f"serve.py: COMMAND = {' '.join(command[:1]) or 'none'}: allowed is a program that can be run")
write, most = "--write" in options, 40
if write:
    options.remove("--write")
if options[:1] == ["--most"] and len(options) == 2 and options[1].isdecimal() and int(options[1]):
    most, options = int(options[1]), []
if options:
    sys.exit(__doc__.strip())
terminals = terminado.UniqueTermManager(max_terminals=most, shell_command=command)
handlers = [
    ("/", Page),
    ("/socket", Socket, {"term_manager": terminals}),
    (r"/js/([\w@./-]*)", tornado.web.StaticFileHandler, {"path": "node_modules/@xterm"}),
]
# A foreign name that is made to point here (DNS rebinding) gets 404.
application = tornado.web.Application()
application.add_handlers(r"^(localhost|127\.0\.0\.1)$", handlers)
try:
    application.listen(int(port), "127.0.0.1")
except OSError as error:
    sys.exit(f"serve.py: PORT = {port}: {error.strerror}")
tornado.ioloop.IOLoop.current().start()
