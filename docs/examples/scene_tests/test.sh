#!/bin/sh
# Runs every scene and compares it with its reference. `./test.sh --accept` makes the references anew instead:
# look at what has changed, and commit them with the change that is the reason.
cd "$(dirname "$0")" || exit 1
program=${RDSOLVE:-rdsolve}
failed=0
for deck in scenes/*.toml; do
    name=$(basename "$deck" .toml)
    if ! "$program" "$deck" -o "new/$name" --overwrite --quiet; then
        echo "FAILED $name: it does not run, or misses what it expects"
        failed=1
    elif [ "$1" = --accept ]; then
        rm -rf "reference/$name"
        mkdir -p "reference/$name"
        cp "new/$name"/*.csv "new/$name/result.json" "reference/$name"
    elif [ ! -d "reference/$name" ]; then
        echo "FAILED $name: it has no reference yet; look at new/$name, then ./test.sh --accept"
        failed=1
    elif ! "$program" compare "reference/$name" "new/$name" --tolerance 1e-6 --quiet; then
        echo "FAILED $name: not what it was"
        failed=1
    fi
done
exit $failed
