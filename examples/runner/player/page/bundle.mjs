// One template of a page from what lies in this folder and three.js, as C++:   node bundle.mjs NODE_MODULES OUT.cpp
// Left to fill in: @FILM@ and @DATA@.
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import zlib from 'node:zlib';

const [, , modules, out] = process.argv, here = path.dirname(fileURLToPath(import.meta.url));
const esbuild = createRequire(`${path.resolve(modules)}/`)('esbuild');
const {outputFiles: [script]} = esbuild.buildSync({
  entryPoints: [`${here}/main.js`], nodePaths: [modules], bundle: true, minify: true, format: 'iife', globalName: 'player',
  target: 'es2022', charset: 'ascii', legalComments: 'none', write: false,
});
const read = file => fs.readFileSync(file, 'utf8');
const parts = {
  STYLE: read(`${here}/style.css`),
  LICENCE: read(`${modules}/three/LICENSE`),
  SCRIPT: zlib.deflateSync(script.contents, {level: 9}).toString('base64'),
};
const page = Object.entries(parts).reduce((text, [mark, part]) => text.replace(`@${mark}@`, () => part), read(`${here}/page.html`));

// In pieces, as compilers need not take long literals.
const pieces = page.match(/[^]{1,16000}/g).map(piece => `R"page(${piece})page"`);
fs.writeFileSync(out, `#include "player/page.h"

namespace tendril::runner {

std::string page_template() {
  std::string out;
  for (const char* piece : {${pieces.join(',\n')}})
    out += piece;
  return out;
}

}  // namespace tendril::runner
`);
console.log(`player: ${script.contents.length} bytes of script, ${parts.SCRIPT.length} in a page`);
