// Small helpers over WebGL 2.

function program(gl, vertex, fragment, outputs) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  if (outputs) gl.transformFeedbackVaryings(made, outputs, gl.SEPARATE_ATTRIBS);
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

// The same, made once for all who ask.
function shared(gl, vertex, fragment) {
  const known = gl.programs ??= new Map(), key = vertex + fragment;
  if (!known.has(key)) known.set(key, program(gl, vertex, fragment));
  return known.get(key);
}

// Of the vertex array that is bound; values may be a buffer that is filled already.
function attribute(gl, made, name, values, size, integer = false, divisor = 0) {
  const given = values instanceof WebGLBuffer, buffer = given ? values : gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  if (!given) gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
  const at = gl.getAttribLocation(made, name);
  if (at < 0) return buffer;
  gl.enableVertexAttribArray(at);
  if (integer) gl.vertexAttribIPointer(at, size, gl.UNSIGNED_INT, 0, 0);
  else if (values instanceof Uint8Array) gl.vertexAttribPointer(at, size, gl.UNSIGNED_BYTE, true, 0, 0);
  else gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
  gl.vertexAttribDivisor(at, divisor);
  return buffer;
}

function texture(gl, width, height, values = null) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
  for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, which, gl.NEAREST);
  for (const which of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, which, gl.CLAMP_TO_EDGE);
  return made;
}

function upload(gl, made, width, height, values) {
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, values);
}

function bind(gl, made, textures) {
  Object.entries(textures).forEach(([name, one], unit) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, one);
    gl.uniform1i(gl.getUniformLocation(made, name), unit);
  });
  gl.activeTexture(gl.TEXTURE0);
}

// Column-major 4 x 4.
function multiply(a, b) {
  const out = new Array(16).fill(0);
  for (let c = 0; c < 4; ++c) for (let r = 0; r < 4; ++r) for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}
