// The study as the page uses it.

export const study = JSON.parse(document.getElementById("study-data").textContent);

/// Curves and pictures to compare the others with; by their names, which is all that a study says of them.
export const is_reference = (name) => /^(numeric|reference|max\(0, cos\))/i.test(name);
