#!/usr/bin/env bash
# Builds the site of the documentation, pages and reference of the API, both with search, in build/site.
#
# usage: tools/docs.sh [--open]
#
#   --open   show it in the browser afterwards
#   --help   print this
#
# The navigation follows docs/index.md. A broken link and a warning of Doxygen are errors. Missing Debian
# packages are installed first (as root or through sudo).

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

open=false
for argument in "$@"; do
  case $argument in
    --open) open=true ;;
    --help) usage; exit ;;
    *) usage >&2; exit 2 ;;
  esac
done

require_packages docs
mkdir -p build/docs

say "reference of the API"
warnings=build/docs/doxygen-warnings.txt
doxygen tools/docs/Doxyfile
if [[ -s $warnings ]]; then
  cat "$warnings" >&2
  die "Doxygen warns"
fi

say "pages"
python3 -B tools/docs/pages.py . build/docs
cp -r build/docs/doxygen/html build/docs/pages/api
mkdocs build --strict --quiet --clean --config-file build/docs/mkdocs.yml

echo "build/site/index.html: $(find build/site -name '*.html' | wc -l) pages"
if "$open"; then xdg-open build/site/index.html; fi
