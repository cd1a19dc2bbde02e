#!/bin/sh
# keep_exit.sh RESULT COMMAND...: runs the program of a test and writes its exit code to RESULT.exit; a program may crash when its result
# is written. Beside registered_tests.txt, scripts/count_tests.py reads both.
exit=$1.exit
shift
mkdir -p "$(dirname "$exit")"
rm -f "$exit"
"$@"
code=$?
echo $code >"$exit"
exit $code
