#!/usr/bin/env bash
# The explorer where people use it: through SSH, in tmux and in screen. It must
# open, follow keys and sizes, send few bytes, and leave the terminal as it was,
# also if the reader of its output stands still or is gone.
#
#   tests/ssh.sh [--install] [path of rubscope, by default target/release or target/debug]
#
# Starts its own sshd on the loopback interface, with keys made here, in a
# temporary directory. Skips what is not installed, with a line; `--install`
# installs it first where apt-get and the rights are there. Exit status 1 if a
# check fails.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
PATH=$PATH:/usr/sbin:/sbin

say() { printf '%s\n' "$*"; }
skip() { say "skipped: $*"; }
fail() {
    say "FAILED: $*" >&2
    exit 1
}

install=no
if [ "${1:-}" = --install ]; then
    install=yes
    shift
fi
program=${1:-$here/target/release/rubscope}
[ -x "$program" ] || program=$here/target/debug/rubscope
[ -x "$program" ] || fail "no rubscope at $program: run cargo build first"
program=$(realpath "$program")

have_all() { command -v sshd && command -v ssh && command -v tmux && command -v screen; }
if [ "$install" = yes ] && ! have_all >/dev/null && command -v apt-get >/dev/null; then
    as_root=()
    [ "$(id -u)" -eq 0 ] || as_root=(sudo -n)
    { "${as_root[@]}" apt-get update &&
        DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install --yes \
            --no-install-recommends openssh-server openssh-client tmux screen; } \
        >/dev/null 2>&1 || say "openssh-server, tmux and screen cannot be installed here"
fi
if ! [ -r /proc/self/io ] || ! command -v tmux >/dev/null; then
    skip "tmux, which types and looks here, is not installed, or /proc is not that of Linux"
    exit 0
fi

work=$(mktemp -d)
chmod 700 "$work"
made_run_sshd=no
sshd=''
cleanup() {
    tmux -L rubscope kill-server 2>/dev/null || true
    close_screen 2>/dev/null || true
    if [ -n "$sshd" ]; then kill "$sshd" 2>/dev/null || true; fi
    if [ $made_run_sshd = yes ]; then rmdir /run/sshd 2>/dev/null || true; fi
    rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 1' INT TERM HUP
# Nothing of the user's: no socket, no settings, no agent.
export TMUX_TMPDIR=$work SCREENDIR=$work/screens LC_ALL=C.UTF-8
unset TMUX STY SSH_AUTH_SOCK
mkdir -m 700 "$SCREENDIR"

# The terminal of this test is a pane of a tmux of its own.
driver() { tmux -L rubscope -u "$@"; }
asked() { driver display-message -p -t pane "#{$1}"; }
shown() { driver capture-pane -p -t pane; }
type_in() { driver send-keys -t pane -l -- "$1"; }
press() { driver send-keys -t pane "$@"; }
resize() { driver resize-window -t pane -x "$1" -y "$2"; }
# A session that stays: without one, the server of tmux ends.
driver -f /dev/null new-session -d -s keeper 'exec sleep 100000'
# Without status line a window is as large as its pane.
driver set-option -g status off
driver set-option -g remain-on-exit on
# Opens the pane, 120 x 40, with a command in it.
open_pane() {
    driver kill-session -t pane 2>/dev/null || true
    driver new-session -d -s pane -x 120 -y 40 "exec $*"
    resize 120 40
}

# Patience, not a speed: a busy machine is slow.
await() {
    local began=$SECONDS
    until "$@" >/dev/null 2>&1; do
        [ $((SECONDS - began)) -lt "${patience:-60}" ] || return 1
        sleep 0.1
    done
}
shows() { shown | grep -qF -- "$1"; }
expect() { await shows "$1" || fail "the screen does not show '$1': $(shown)"; }
# A process is gone if it has no program; a dead one that waits for its parent has none.
is_gone() { ! readlink "/proc/$1/exe"; }
written() { awk '/^wchar/ { print $2 }' "/proc/$1/io"; }
received() { awk '/^rchar/ { print $2 }' "/proc/$1/io"; }

shell="env PS1=ready: XDG_CONFIG_HOME=$work/config bash --norc --noprofile -i"
# Types a command for the shell in the pane and waits until it is done.
in_shell() {
    rm -f "$work/done"
    type_in " $1; echo \$? > $work/done"
    press Enter
    await test -s "$work/done" || fail "the shell does not do '$1': $(shown)"
}
# Starts the explorer from the shell in the pane; `pid` is its process.
start_explorer() {
    expect 'ready:'
    in_shell "cd $work; clear; echo BEFORE; stty -g > $work/before"
    rm -f "$work/pid"
    type_in " sh -c 'echo \$\$ > $work/pid; exec $program --step 2e-7 --end 0.02 $*'"
    press Enter
    expect ' LOCKED '
    pid=$(cat "$work/pid")
}
# The shell has its terminal back as it was before the explorer.
expect_restored() {
    await shows 'BEFORE' || fail "what was on the screen before is not back: $(shown)"
    ! shows ' LOCKED ' || fail "the explorer is still on the screen: $(shown)"
    [ "$(asked cursor_flag)" = 1 ] || fail "the cursor is hidden"
    press C-u
    in_shell "stty -g > $work/after"
    cmp -s "$work/before" "$work/after" ||
        fail "the terminal was $(cat "$work/before") and now is $(cat "$work/after")"
}
# A full picture again and again, until the explorer cannot write any more:
# whoever reads its terminal stands still. Another size makes it draw everything.
# More than four million bytes are held nowhere: then somebody reads.
fill_output() {
    local tty start before now=-1 still=0 turn=0
    tty=$(readlink "/proc/$pid/fd/0")
    start=$(written "$pid")
    while [ "$now" -lt $((start + 4000000)) ]; do
        turn=$((turn + 1))
        stty -F "$tty" rows $((100 + turn % 2)) cols 300
        sleep 0.05
        before=$now
        now=$(written "$pid")
        if [ "$now" = "$before" ]; then still=$((still + 1)); else still=0; fi
        if [ $still -gt 30 ]; then return 0; fi
    done
    return 1
}
# A signal to end must end it soon, whatever it is doing.
expect_end() {
    local began=$SECONDS
    kill -TERM "$pid"
    patience=15 await is_gone "$pid" || {
        kill -KILL "$pid"
        fail "15 s after TERM it still runs: $1"
    }
    say "  ended $((SECONDS - began)) s after TERM: $1"
}

opens_and_follows() {
    press j j j j j
    expect 'Contact law'
    press l
    expect ' DECAY '
    press h
    expect ' LOCKED '
    for size in '80 24' '40 12' '200 60' '120 40'; do
        # shellcheck disable=SC2086
        resize $size
        await is_drawn "$size" || fail "at $size the screen is $(shown)"
    done
    expect ' LOCKED '
    press q
    await is_gone "$pid" || fail "q does not end it"
    expect_restored
}
# The terminal has the size and the last line has something in it.
is_drawn() {
    [ "$(stty -F "$(readlink "/proc/$pid/fd/0")" size)" = "${1#* } ${1% *}" ] &&
        shown | tail -n 1 | grep -q '[^ ]' && shows 'NOW '
}

# --- SSH -----------------------------------------------------------------

start_sshd() {
    ssh-keygen -q -t ed25519 -N '' -f "$work/host_key"
    ssh-keygen -q -t ed25519 -N '' -f "$work/user_key"
    cp "$work/user_key.pub" "$work/authorized_keys"
    if [ "$(id -u)" -eq 0 ] && ! [ -d /run/sshd ]; then
        # The daemon of root locks itself in there.
        mkdir -m 755 /run/sshd
        made_run_sshd=yes
    fi
    for _ in 1 2 3 4 5; do
        port=$((20000 + RANDOM % 30000))
        cat >"$work/sshd_config" <<CONF
Port $port
ListenAddress 127.0.0.1
HostKey $work/host_key
AuthorizedKeysFile $work/authorized_keys
PidFile none
StrictModes no
UsePAM no
PasswordAuthentication no
KbdInteractiveAuthentication no
PermitRootLogin prohibit-password
PrintMotd no
PrintLastLog no
CONF
        "$(command -v sshd)" -D -e -f "$work/sshd_config" 2>"$work/sshd.log" &
        sshd=$!
        printf '[127.0.0.1]:%s %s\n' "$port" "$(cut -d' ' -f1,2 "$work/host_key.pub")" >"$work/known_hosts"
        if patience=10 await is_listening; then return 0; fi
        # Another port only where this one was taken.
        ! kill "$sshd" 2>/dev/null || break
    done
    sshd=''
    return 1
}
client() {
    printf 'ssh -F none -p %s -i %s -o UserKnownHostsFile=%s -o StrictHostKeyChecking=yes ' \
        "$port" "$work/user_key" "$work/known_hosts"
    printf -- '-o IdentitiesOnly=yes -o IdentityAgent=none -o BatchMode=yes -o LogLevel=ERROR %s@127.0.0.1' "$(id -un)"
}
# With a terminal: not every daemon of a normal user may give one.
is_listening() { $(client) -tt true </dev/null; }
# The client must not be a child of tmux, which wakes its stopped children.
open_ssh() {
    cat >"$work/connect" <<SH
sh -c 'echo \$\$ > $work/client; exec $(client) -tt "LC_ALL=C.UTF-8 exec $shell"'
echo the connection is closed
SH
    rm -f "$work/client"
    open_pane "sh $work/connect"
    await test -s "$work/client" || fail 'the client does not start'
    client_pid=$(cat "$work/client")
}

ssh_opens() {
    open_ssh
    start_explorer
    opens_and_follows
}
# Bytes a second: of the explorer, and through the connection.
rate() {
    local before after seconds=5
    before="$(written "$pid") $(received "$client_pid")"
    sleep $seconds
    after="$(written "$pid") $(received "$client_pid")"
    # shellcheck disable=SC2086
    set -- $before $after
    most=$((($3 - $1) / seconds))
    say "  $what at 120x40: $most B/s written, $((($4 - $2) / seconds)) B/s through the connection"
}
ssh_sends_little() {
    open_ssh
    start_explorer
    sleep 2
    what=playing rate
    [ $most -lt 20000 ] || fail "more than 20 kB/s while it plays"
    press Space
    sleep 2
    what=paused rate
    [ $most -lt 1000 ] || fail "more than 1 kB/s while it is paused"
    press q
    await is_gone "$pid" || fail "q does not end it"
}
ssh_frozen_client() {
    open_ssh
    start_explorer
    kill -STOP "$client_pid"
    local began
    began=$(written "$pid")
    fill_output || fail "a frozen client does not stop its output"
    say "  its output stood still after $(($(written "$pid") - began)) B"
    expect_end "the client is frozen"
    kill -CONT "$client_pid"
    [ "$(patience=20 await is_off_alternate && asked alternate_on)" = 0 ] ||
        fail "still on the alternate screen after the client went on"
    expect_restored
}
is_off_alternate() { [ "$(asked alternate_on)" = 0 ]; }
ssh_cut() {
    open_ssh
    start_explorer
    kill -KILL "$client_pid"
    await is_gone "$pid" || fail "it runs on without its connection"
    say "  gone after its connection was cut"
}

# --- tmux and screen -----------------------------------------------------

tmux_opens() {
    open_pane "$shell"
    start_explorer
    opens_and_follows
}
tmux_copy_mode() {
    open_pane "$shell"
    start_explorer
    driver copy-mode -t pane
    [ "$(asked pane_in_mode)" = 1 ] || fail "tmux is not in copy mode"
    if fill_output; then say "  copy mode stops its output"; else say "  copy mode lets its output through"; fi
    expect_end "tmux is in copy mode"
    press -X cancel
    await is_off_alternate || fail "still on the alternate screen"
    expect_restored
}
open_screen() {
    cat >"$work/screenrc" <<'CONF'
startup_message off
altscreen on
defutf8 on
hardstatus off
CONF
    open_pane "screen -U -c $work/screenrc -S rubscope $shell"
}
close_screen() { screen -S rubscope -X quit >/dev/null; }
screen_opens() {
    open_screen
    start_explorer
    opens_and_follows
    close_screen
}
screen_copy_mode() {
    open_screen
    start_explorer
    screen -S rubscope -p 0 -X copy
    expect 'Copy mode'
    if fill_output; then say "  copy mode stops its output"; else say "  copy mode lets its output through"; fi
    expect_end "screen is in copy mode"
    press Escape
    expect_restored
    close_screen
}

# --- all of them ----------------------------------------------------------

failed=()
# One check by its name: `CHECK=ssh_cut tests/ssh.sh`.
check() {
    [ "${CHECK:-$1}" = "$1" ] || return 0
    say "$1"
    # In a shell of its own, so that the checks after a failed one still run.
    ("$1") || failed+=("$1")
}
began=$SECONDS
if ! command -v sshd >/dev/null || ! command -v ssh >/dev/null; then
    skip "openssh-server or openssh-client is not installed"
elif ! start_sshd; then
    reason=$(grep -m 1 -iE 'chown|error|denied|not allowed' "$work/sshd.log" || tail -n 1 "$work/sshd.log")
    skip "sshd does not start or gives no terminal: $reason"
else
    check ssh_opens
    check ssh_sends_little
    check ssh_cut
    check ssh_frozen_client
fi
check tmux_opens
check tmux_copy_mode
if command -v screen >/dev/null; then
    check screen_opens
    check screen_copy_mode
else
    skip "screen is not installed"
fi
[ ${#failed[@]} -eq 0 ] || fail "${failed[*]}"
say "passed in $((SECONDS - began)) s"
