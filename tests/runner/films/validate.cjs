// What the Khronos validator finds in a glTF file, as JSON:   node validate.cjs NODE_MODULES FILE
const fs = require('fs');
const [, , modules, file] = process.argv;
const validator = require(`${modules}/gltf-validator`);
validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 20}).then(report => {
  const {numErrors: errors, numWarnings: warnings, numInfos: infos, messages} = report.issues;
  console.log(JSON.stringify({errors, warnings, infos, messages}));
});
