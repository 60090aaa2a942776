#!/bin/sh
# docs.sh: the documents and the references of the C interface, the Fortran module and the Rust functions, into target/docs, a site
# that opens from its index.html without a network. What is not understood is an error, and what has no comment in C or Rust, from
# which the Fortran module is generated. FORD comes from PyPI, into target/tools.
set -eu

cd "$(dirname "$0")/.."
. tools/checks.sh
export MSLIP_VERSION="$version"
out=target/docs

fortran() {
    pypi ford ford==7.0.13
    target/tools/ford/bin/ford docs/reference/ford.md > "$work/ford" 2>&1 || { cat "$work/ford"; return 1; }
    ! grep 'Warning' "$work/ford"
}

rust() {
    RUSTDOCFLAGS='-D warnings' $CARGO doc --quiet --no-deps --locked --package microslip --target-dir target/docs/rust-build &&
        cp -R $out/rust-build/doc $out/rust
}

# Beside the files of the repository, to which they refer.
documents() {
    git ls-files -z | xargs -0 cp --parents --target-directory $out
    for document in $(git ls-files '*.md' ':!docs/reference'); do
        # shellcheck disable=SC2016 # backticks of Markdown
        sed 's/\$`/$/g; s/`\$/$/g' "$document" |
            pandoc --from commonmark_x+gfm_auto_identifiers --to html5 --standalone --mathml --toc --fail-if-warnings \
                --variable pagetitle="$(sed -n '1s/^#* *//p' "$document")" --lua-filter docs/reference/links.lua \
                --output "$out/${document%.md}.html" || return 1
    done
    {
        echo '<p>References: <a href="c/index.html">C</a>, <a href="fortran/index.html">Fortran</a>, <a href="rust/index.html">Rust</a></p>'
        cat $out/README.html
    } > $out/index.html
}

rm -rf $out
mkdir -p $out
check 'C: every function has its reference' doxygen docs/reference/Doxyfile
check 'Fortran: every procedure has its reference' fortran
check 'Rust: every item has its reference' rust
rm -rf $out/rust-build
cp docs/cluster.md $out # to which the C reference refers
echo '<meta http-equiv="refresh" content="0; url=microslip/index.html">' > $out/rust/index.html # to which its pages refer

check 'documents: pages with figures and formulas' documents
check 'all links lead to files, of the site or of others' python3 docs/reference/site.py $out
counts
