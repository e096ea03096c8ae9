#!/usr/bin/env python3
"""The commands of docs/classroom.md, without a browser: the page of the class
shows the session and cannot type, the page of the teacher can.

    tests/classroom.py PROGRAM

Needs tmux, and terminado in this Python. Exit status 1 if a check fails.
"""
import asyncio
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

root = pathlib.Path(__file__).resolve().parent.parent
text = (root / "docs/classroom.md").read_text()
blocks = [block.replace("\\\n", " ") for block in re.findall(r"```sh\n(.*?)```", text, re.S)]
lines = [line.strip() for block in blocks for line in block.splitlines()]
work = pathlib.Path(tempfile.mkdtemp())
(work / "bin").mkdir()
(work / "bin/rubscope").symlink_to(pathlib.Path(sys.argv[1]).resolve())
os.environ.update(
    PATH=f"{work}/bin:{os.environ['PATH']}",
    TMUX_TMPDIR=str(work),
    RUBSCOPE=str(root),
    XDG_CONFIG_HOME=str(work),
    LC_ALL="C",
)
os.environ.pop("TMUX", None)


def screen():
    tmux = ["tmux", "-L", "class", "capture-pane", "-p", "-t", "rub"]
    return subprocess.run(tmux, capture_output=True, text=True, encoding="utf-8").stdout


def expect(what, found, patience=60):
    until = time.monotonic() + patience
    while not found():
        if time.monotonic() > until:
            sys.exit(f"FAILED: {what}\n{screen()}")
        time.sleep(0.1)


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


servers = []


def serve(command):
    """Starts a command of the page on a free port, and waits for the port."""
    port = free_port()
    command = re.sub(r"serve\.py\" \d+", f'serve.py" {port}', command)
    command = command.replace("~/classroom/bin/python", sys.executable)
    servers.append(subprocess.Popen(["sh", "-c", f"exec {command}"], cwd=work))

    def listens():
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", port)) == 0

    expect(f"{command} listens", listens)
    return port


async def page(port, origin=None):
    """Opens a page's socket as a window of 130 x 45."""
    headers = {"Origin": origin or f"http://127.0.0.1:{port}"}
    opened = await websocket_connect(HTTPRequest(f"ws://127.0.0.1:{port}/socket", headers=headers))
    await opened.write_message(json.dumps(["set_size", 45, 130]))
    return opened


async def shows(opened, *words):
    """Reads what the page is sent until all of these words were in it."""
    seen = ""
    while not all(word in seen for word in words):
        message = await asyncio.wait_for(opened.read_message(), 60)
        if message is None:
            sys.exit(f"FAILED: a page was closed\n{screen()}")
        kind, sent = json.loads(message)[:2]
        seen += sent if kind == "stdout" else ""
    return seen


async def types(opened, keys):
    await opened.write_message(json.dumps(["stdin", keys]))


async def check():
    (class_line,) = [line for line in lines if "serve.py" in line]
    assert " attach -r " in class_line
    # A page that can type, as the page says of `--write`.
    teacher_line = class_line.replace(" -r ", " ").replace(" -- ", " --write -- ")
    teacher = await page(serve(teacher_line))
    port = serve(class_line)
    few = serve(class_line.replace(" -- ", " --most 2 -- "))
    watching = [await page(few), await page(few)]
    for opened in watching:
        await shows(opened, "LOCKED")
    third = await page(few)
    assert await asyncio.wait_for(third.read_message(), 60) is None, "a third page was let in"
    assert "2 pages are open" in third.close_reason, third.close_reason
    watching.pop().close()
    await asyncio.sleep(1)
    await shows(await page(few), "LOCKED")
    # Each of the two locks holds alone.
    only_server = serve(class_line.replace(" -r ", " "))
    only_tmux = serve(class_line.replace(" -- ", " --write -- "))
    seen = await shows(await page(port), "LOCKED", "quit")
    assert re.search("[\u2801-\u28ff]", seen), "the page of the class has no braille"
    assert re.search("\x1b\\[[0-9;]*[39][1-7]m", seen), "it has no colours"
    for locked in port, only_server, only_tmux:
        opened = await page(locked)
        await shows(opened, "LOCKED")
        await types(opened, "q")
        await types(opened, "\x02:kill-server\r")
        await types(opened, "\x03")
    await shows(teacher, "LOCKED")
    await types(teacher, ":speed 430\r")
    expect("the key of the teacher turns a knob", lambda: " 430 rad/s" in screen())
    await shows(await page(port), "430 rad/s")
    # The tmux keys are gone: no shell can be opened.
    await types(teacher, "\x02c")
    await types(teacher, ":speed 440\r")
    expect("the session goes on", lambda: " 440 rad/s" in screen())
    count = ["tmux", "-L", "class", "list-windows", "-t", "rub"]
    windows = subprocess.run(count, capture_output=True, text=True).stdout
    assert windows.count("\n") == 1, f"a window was opened: {windows}"
    assert "[120x40]" in windows, f"a page changed the size: {windows}"
    for host, expected in ("localhost", "200"), ("elsewhere.example", "404"):
        for path in "/", "/socket":
            request = f"GET {path} HTTP/1.0\r\nHost: {host}:{port}\r\n\r\n".encode()
            with socket.create_connection(("127.0.0.1", port)) as asked:
                asked.sendall(request)
                told = asked.recv(12).decode()
            found = told == f"HTTP/1.1 {expected}"
            # The socket answers a plain question with a 400.
            found |= (path, expected) == ("/socket", "200") and told.endswith("400")
            assert found, f"{host}{path}: {told}"
    try:
        await page(port, "http://elsewhere.example")
    except Exception as refused:
        assert "403" in str(refused), refused
    else:
        sys.exit("FAILED: a page from elsewhere may open the socket")
    # The c after Ctrl-B compares with the other law; q closes that first.
    await types(teacher, "qq")
    expect("a changed scene is asked about", lambda: "the scene is changed" in screen())
    await types(teacher, "q")


try:
    session = blocks[0].split("ttyd")[0]
    subprocess.run(["sh", "-ec", session], cwd=work, check=True)
    expect("the explorer opens", lambda: " LOCKED " in screen())
    asyncio.run(check())
    expect("q ends the session", lambda: screen() == "")
    print("the class watches and cannot type, the teacher types")
finally:
    for server in servers:
        server.terminate()
    subprocess.run(["tmux", "-L", "class", "kill-server"], capture_output=True)
    for server in servers:
        server.wait()
    shutil.rmtree(work)
