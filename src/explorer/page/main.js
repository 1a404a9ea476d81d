const scene = await (await fetch("api/scene")).json();
document.title = `${scene.name} – inbetween`;
document.getElementById("status").textContent = `${scene.name}: ${scene.poses.length} poses`;
