#!/bin/sh
# run_example.sh SERVER EXAMPLE: runs the example through a server of its own on a unix socket.
set -eu
dir=$(mktemp -d)  # a short path: names of unix sockets are limited to 107 bytes
trap 'kill "$server" 2>/dev/null || true; rm -rf "$dir"' EXIT
"$1" --listen "unix:$dir/s" --log-level warn &
server=$!
tries=0
while [ ! -S "$dir/s" ] && [ "$tries" -lt 200 ]; do
  sleep 0.05
  tries=$((tries + 1))
done
"$2" "unix:$dir/s"
kill -TERM "$server"
wait "$server"
